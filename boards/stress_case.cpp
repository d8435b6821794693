#include "boards/stress_case.hpp"

#include <cmath>
#include <iterator>

namespace forager::boards {

std::vector<double> evenly(double from, double to, double step) {
  std::vector<double> values;
  for (int i = 0; from + i * step <= to; ++i) values.push_back(from + i * step);
  return values;
}

std::vector<double> geometrically(double from, double to, double factor) {
  std::vector<double> values;
  for (int i = 0; from * std::pow(factor, i) <= to; ++i) values.push_back(from * std::pow(factor, i));
  return values;
}

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
