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

TimedWork::TimedWork(const std::function<void()>& work, Seconds shortest)
    : work_(&work), calls_(calls_for(work, shortest)) {}

double TimedWork::once_s() const { return time_of(*work_, calls_).count() / static_cast<double>(calls_); }

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
  const TimedWork our_work(duel.ours, options.shortest);
  const TimedWork other_work(duel.other, options.shortest);
  std::vector<double> ours;
  std::vector<double> others;
  for (int i = 0; i < options.repeats; ++i) {
    ours.push_back(duel.items / our_work.once_s());
    others.push_back(duel.items / other_work.once_s());
  }
  return BenchRow{duel.name, median_of(std::move(ours)), duel.unit, duel.peer, median_of(std::move(others))};
}

}  // namespace forager::tools
