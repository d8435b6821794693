#pragma once

#include <span>
#include <string>
#include <vector>

#include "boards/accuracy_row.hpp"

namespace forager::tools {

// A row, and whether anything beats it: no other row of its name is at most as slow, as wrong and as often
// without an answer, and better in one of these.
struct AccuracyLine {
  boards::AccuracyRow row;
  bool pareto = false;
};

// Marks the Pareto front of each name. Rows without a time are on none.
[[nodiscard]] std::vector<AccuracyLine> with_pareto_fronts(std::vector<boards::AccuracyRow> rows);

// For a person: a heading per name, a line per variant, "*" on the front.
[[nodiscard]] std::string accuracy_text(std::span<const AccuracyLine> lines);
// RFC 4180 with a header line.
[[nodiscard]] std::string accuracy_csv(std::span<const AccuracyLine> lines);
// One JSON object a line.
[[nodiscard]] std::string accuracy_json(std::span<const AccuracyLine> lines);
// A self-contained page: per name a plot of error over time with the front drawn, and the table.
[[nodiscard]] std::string accuracy_page(std::span<const AccuracyLine> lines);

}  // namespace forager::tools
