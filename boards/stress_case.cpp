#include "boards/stress_case.hpp"

#include <iterator>

namespace forager::boards {

std::vector<StressCase> stress_cases() {
  using Topic = std::vector<StressCase> (*)();
  constexpr Topic kTopics[] = {
      stress_detection,
      stress_geometry,
      stress_numbers,
      stress_wire,
  };
  std::vector<StressCase> cases;
  for (const Topic topic : kTopics) {
    std::vector<StressCase> more = topic();
    cases.insert(cases.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  }
  return cases;
}

}  // namespace forager::boards
