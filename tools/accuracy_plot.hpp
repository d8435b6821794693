#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "tools/accuracy_table.hpp"

namespace forager::tools {

// Error over time of rows of one name, both logarithmic, the Pareto front as a stepped line; numbered as in
// the table. `index` makes the drawing's names unique on a page. Empty if no row has a time.
[[nodiscard]] std::string draw_accuracy(std::span<const AccuracyLine> lines, std::size_t index);

}  // namespace forager::tools
