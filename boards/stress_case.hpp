#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace forager::boards {

// One numerically hard question put to the code, and how far off the worst answer was.
struct StressCase {
  std::string name;    // "detection: exact null of the pattern"
  double worst = 0.0;  // worst error found, in the unit of the bound; NaN counts as failed
  double bound = 0.0;  // largest error allowed
  [[nodiscard]] bool ok() const { return worst <= bound; }
};

// Collects the worst error of one case.
class Worst {
 public:
  void add(double error) { worst_ = std::isnan(error) || error > worst_ ? error : worst_; }
  // Something that is either so or not: 0, or infinite.
  void must(bool holds) { add(holds ? 0.0 : HUGE_VAL); }
  void near(double value, double expected) { add(value == expected ? 0.0 : std::abs(value - expected)); }
  void relative(double value, double expected) {
    add(value == expected ? 0.0 : std::abs(value - expected) / std::abs(expected));
  }
  [[nodiscard]] StressCase against(std::string name, double bound) const {
    return {std::move(name), worst_, bound};
  }

 private:
  double worst_ = 0.0;
};

// from, from + step, ... and from, from * factor, ... to `to` at most. Counted in whole numbers: a sum of
// steps drifts.
[[nodiscard]] std::vector<double> evenly(double from, double to, double step);
[[nodiscard]] std::vector<double> geometrically(double from, double to, double factor);

// Every case of every topic, in a fixed order. To add one: boards/stress_<topic>.cpp with
// std::vector<StressCase> stress_<topic>(), declared here and named in boards/stress_case.cpp.
[[nodiscard]] std::vector<StressCase> stress_cases();

[[nodiscard]] std::vector<StressCase> stress_detection();
[[nodiscard]] std::vector<StressCase> stress_geometry();
[[nodiscard]] std::vector<StressCase> stress_numbers();
[[nodiscard]] std::vector<StressCase> stress_wire();

}  // namespace forager::boards
