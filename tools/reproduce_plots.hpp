#pragma once

#include <cstddef>
#include <string>

#include "boards/reproduce.hpp"

namespace forager::tools {

// One row an experiment: the published share of tags read as a ring, the simulated median as a dot on its 5
// to 95 % range. Empty without experiments.
[[nodiscard]] std::string draw_coverages(const boards::Reproduction& result);

// Median of the tags heard so far with its band, the published count as a dashed line. `index` makes the
// drawing's names unique on a page. Empty without a curve.
[[nodiscard]] std::string draw_tags_against_time(const boards::ReproducedRun& run, std::size_t index);

}  // namespace forager::tools
