#include "boards/accuracy_row.hpp"

#include <iterator>

namespace forager::boards {

std::vector<AccuracyRow> accuracy_rows(const AccuracyOptions& options) {
  using Topic = std::vector<AccuracyRow> (*)(const AccuracyOptions&);
  constexpr Topic kTopics[] = {
      accuracy_detection, accuracy_sweep,   accuracy_air,
      accuracy_guard,     accuracy_planner, accuracy_relative_pose,
  };
  std::vector<AccuracyRow> rows;
  for (const Topic topic : kTopics) {
    std::vector<AccuracyRow> more = topic(options);
    rows.insert(rows.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  }
  return rows;
}

}  // namespace forager::boards
