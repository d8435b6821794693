#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hal/error.hpp"
#include "tools/bench_row.hpp"

namespace forager::tools {

// Keeps the compiler from leaving out what computes a value.
template <class T>
void keep(const T& value) {
  asm volatile("" : : "g"(&value) : "memory");
}

// A piece of the hot path and another way to do the same work.
struct Duel {
  std::string name;
  std::string unit;  // "events/s"
  std::string peer;
  double items = 1.0;  // of the unit, done by one call of either
  std::function<void()> ours;
  std::function<void()> other;
  // Whether both came to the same result, for one call of each; asked before anything is measured.
  std::function<bool()> agree;
};

struct DuelOptions {
  int repeats = 9;                                // measurements of each, taken in turn
  std::chrono::duration<double> shortest{20e-3};  // one measurement lasts at least this long
};

// Middle of the values; the mean of the middle two. Not empty.
[[nodiscard]] double median_of(std::vector<double> values);

// Seconds one call takes: so many calls at once that they last `shortest`, which warms the caches on the way.
struct TimedWork {
  TimedWork(const std::function<void()>& work, std::chrono::duration<double> shortest);
  [[nodiscard]] double once_s() const;

 private:
  const std::function<void()>* work_;
  std::uint64_t calls_ = 1;
};

// Medians of both, measured turn by turn so that whatever else the machine does meets both alike. Errors:
// protocol, they do not agree.
[[nodiscard]] hal::Result<BenchRow> measure(const Duel& duel, const DuelOptions& options);

// The hot paths between bytes and decisions.
[[nodiscard]] Duel advannet_duel();        // event stream message -> reads, against a pugixml tree
[[nodiscard]] Duel mavlink_encode_duel();  // ATTITUDE -> frame, against shifts and a bitwise CRC
[[nodiscard]] Duel mavlink_parse_duel();   // frames -> ATTITUDE, against a byte-wise state machine
[[nodiscard]] Duel guard_duel(int columns, int rows);  // obstacle guard, against the minimum of each column
[[nodiscard]] Duel new_tags_duel();  // reads -> new tags per antenna, against hash tables of strings

}  // namespace forager::tools
