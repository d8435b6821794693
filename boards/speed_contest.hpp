#pragma once

#include <functional>
#include <string>
#include <vector>

namespace forager::boards {

// A piece of the simulated world and another way to do the same work, for the outermost loop to time in turn.
struct SpeedContest {
  std::string name;    // "detection, whole formula, f64"
  std::string unit;    // "pairs/s"
  std::string peer;    // "formula as written"
  double items = 1.0;  // of the unit, done by one call of either
  std::function<void()> ours;
  std::function<void()> other;
  // Whether both come to the same result; asked before anything is measured.
  std::function<bool()> agree;
};

// Keeps the compiler from leaving out what computes a value.
template <class T>
void keep_result(const T& value) {
  asm volatile("" : : "g"(&value) : "memory");
}

// Contests of every topic, in a fixed order. To add one: boards/speed_<topic>.cpp with
// std::vector<SpeedContest> speed_<topic>(), declared here and named in boards/speed_contest.cpp.
[[nodiscard]] std::vector<SpeedContest> speed_contests();

// Probability of detection of pairs of tag and antenna: by vectors, against the published plugin's formula as
// it is written. Both held to the exact value.
[[nodiscard]] std::vector<SpeedContest> speed_detection();

// Tags within a radius: the grid against nanoflann, a million tags. Makes its world when called.
[[nodiscard]] std::vector<SpeedContest> speed_tag_grid();

}  // namespace forager::boards
