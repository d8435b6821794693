#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "boards/overhead_contest.hpp"
#include "boards/reproduce.hpp"
#include "hal/error.hpp"

namespace forager::tools {

// Times of one thing, done in two ways right after one another: whatever else the machine does meets both.
struct TimedPair {
  double ours_ns = 0.0;
  double bare_ns = 0.0;
  double ours_cpu_ns = 0.0;  // of the calling thread
  double bare_cpu_ns = 0.0;
};

// What pairs say together. Medians, so that a pair that was interrupted changes nothing.
struct PairedFigures {
  double ours_ns = 0.0;
  double bare_ns = 0.0;
  double added_ns = 0.0;  // of the differences
  double ours_cpu_ns = 0.0;
  double bare_cpu_ns = 0.0;
  boards::Spread ratio;     // of ours / bare
  double ratio_low = 0.0;   // the median ratio lies between these two with 95 % confidence, whatever the
  double ratio_high = 0.0;  // distribution, as far as pairs do not depend on each other
  std::size_t pairs = 0;
};

// At least one pair.
[[nodiscard]] PairedFigures figures_of(std::span<const TimedPair> pairs);

struct PairedOptions {
  double seconds = 2.0;                               // of all pairs together
  std::size_t least = 21;                             // pairs, however long they take
  std::function<bool()> stop = [] { return false; };  // asked after every pair
};

// Opens one side, warms it up, times a batch, closes it; then the other; which is first changes from pair to
// pair. Errors: those of the two sides.
[[nodiscard]] hal::Result<std::vector<TimedPair>> time_pairs(const boards::OverheadContest& contest,
                                                             const PairedOptions& options);

}  // namespace forager::tools
