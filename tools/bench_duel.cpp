#include "tools/bench_duel.hpp"

#include <algorithm>

namespace forager::tools {
namespace {

using WallClock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

Seconds time_of(const std::function<void()>& work, std::uint64_t calls) {
  const auto start = WallClock::now();
  for (std::uint64_t i = 0; i < calls; ++i) work();
  return WallClock::now() - start;
}

// So many calls that they last long enough to be timed; warms the caches on the way.
std::uint64_t calls_for(const std::function<void()>& work, Seconds shortest) {
  constexpr std::uint64_t kMost = 1U << 30U;
  std::uint64_t calls = 1;
  while (calls < kMost && time_of(work, calls) < shortest) calls *= 2;
  return calls;
}

}  // namespace

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2.0;
}

hal::Result<BenchRow> measure(const Duel& duel, const DuelOptions& options) {
  if (!duel.agree())
    return hal::fail(hal::ErrorCode::protocol, "bench", duel.name,
                     "the two ways do not come to the same result",
                     "The figures would mean nothing; run the tests.");
  const std::uint64_t our_calls = calls_for(duel.ours, options.shortest);
  const std::uint64_t other_calls = calls_for(duel.other, options.shortest);
  std::vector<double> ours;
  std::vector<double> others;
  for (int i = 0; i < options.repeats; ++i) {
    ours.push_back(duel.items * static_cast<double>(our_calls) / time_of(duel.ours, our_calls).count());
    others.push_back(duel.items * static_cast<double>(other_calls) /
                     time_of(duel.other, other_calls).count());
  }
  return BenchRow{duel.name, median_of(std::move(ours)), duel.unit, duel.peer, median_of(std::move(others))};
}

}  // namespace forager::tools
