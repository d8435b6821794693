#pragma once

#include <string>

#include "boards/calibration.hpp"

namespace forager::tools {

// Parameters with their intervals, then residuals over range; lines to paste into a scene.
[[nodiscard]] std::string calibration_table(const boards::Calibration& result);

// One JSON row a parameter (parameter, value, low, high ...), one a residual, one closing row.
[[nodiscard]] std::string calibration_json(const boards::Calibration& result);

// One self-contained page: the same with a plot of heard shares over range, observed and expected. No script,
// nothing loaded from elsewhere.
[[nodiscard]] std::string calibration_page(const boards::Calibration& result);

// How a parameter's interval reads, "2.31 - 2.70", "4.2 -" when it is open.
[[nodiscard]] std::string interval_text(const boards::FittedParameter& parameter);

}  // namespace forager::tools
