#pragma once

#include <string>

#include "boards/reproduce.hpp"

namespace forager::tools {

// Published, simulated and difference, one line an experiment, then durations, tags against time of the
// chapter 4 scenes, and what it comes to.
[[nodiscard]] std::string reproduction_table(const boards::Reproduction& result);

// One JSON row an experiment (run, published, median, p5, p95, difference, duration_s ...), then one with
// rms_points. Coverage in per cent, differences in points; what was not published is null.
[[nodiscard]] std::string reproduction_json(const boards::Reproduction& result);

}  // namespace forager::tools
