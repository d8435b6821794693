#include "tools/paired_times.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>
#include <utility>

namespace forager::tools {
namespace {

using WallClock = std::chrono::steady_clock;
using Side = boards::OverheadContest::Side;
using Open = std::function<hal::Result<Side>()>;

double thread_cpu_ns() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e9 + static_cast<double>(time.tv_nsec);
}

struct Batch {
  double wall_ns = 0.0;  // of one thing
  double cpu_ns = 0.0;
};

hal::Result<Batch> time_batch(const Side& side, std::uint64_t calls) {
  const double cpu = thread_cpu_ns();
  const auto start = WallClock::now();
  const auto done = side(calls);
  const std::chrono::duration<double, std::nano> wall = WallClock::now() - start;
  const double cpu_ns = thread_cpu_ns() - cpu;
  if (!done) return hal::fail(done.error());
  const double things = static_cast<double>(std::max<std::uint64_t>(1, *done));
  return Batch{wall.count() / things, cpu_ns / things};
}

// An even number, so that what is toggled, active first, ends inactive. By the fastest call seen: others that
// want the processor make some wait a thousand times as long.
hal::Result<std::uint64_t> calls_for(const boards::OverheadContest& contest) {
  constexpr std::uint64_t kMost = 1U << 24U;
  constexpr int kPatience = 20;  // batches
  const auto side = contest.open_ours();
  if (!side) return hal::fail(side.error());
  double fastest = std::numeric_limits<double>::max();
  for (std::uint64_t calls = 2; calls < kMost; calls *= 2) {
    const auto start = WallClock::now();
    if (const auto done = (*side)(calls); !done) return hal::fail(done.error());
    const double taken = hal::to_seconds(WallClock::now() - start);
    fastest = std::min(fastest, taken / static_cast<double>(calls));
    const double batch = hal::to_seconds(contest.batch);
    if (fastest * static_cast<double>(calls) >= batch || taken >= kPatience * batch) return calls;
  }
  return kMost;
}

hal::Result<Batch> one_side(const Open& open, std::uint64_t calls) {
  const auto side = open();
  if (!side) return hal::fail(side.error());
  if (const auto warm = (*side)(std::max<std::uint64_t>(2, calls / 8)); !warm) return hal::fail(warm.error());
  return time_batch(*side, calls);
}

}  // namespace

PairedFigures figures_of(std::span<const TimedPair> pairs) {
  const auto median = [&pairs](auto value_of) {
    std::vector<double> values;
    values.reserve(pairs.size());
    for (const TimedPair& pair : pairs) values.push_back(value_of(pair));
    return boards::quantile(std::move(values), 0.5);
  };
  std::vector<double> ratios;
  ratios.reserve(pairs.size());
  for (const TimedPair& pair : pairs) ratios.push_back(pair.ours_ns / pair.bare_ns);
  std::sort(ratios.begin(), ratios.end());
  // How many ratios lie below the true median is binomial with p = 1/2: mean n/2, deviation sqrt(n)/2; the
  // last half is the continuity correction.
  constexpr double k95 = 1.96;
  const double n = static_cast<double>(ratios.size());
  const auto below = static_cast<std::size_t>(std::max(0.0, (n - k95 * std::sqrt(n) - 1.0) / 2.0));
  return {.ours_ns = median([](const TimedPair& pair) { return pair.ours_ns; }),
          .bare_ns = median([](const TimedPair& pair) { return pair.bare_ns; }),
          .added_ns = median([](const TimedPair& pair) { return pair.ours_ns - pair.bare_ns; }),
          .ours_cpu_ns = median([](const TimedPair& pair) { return pair.ours_cpu_ns; }),
          .bare_cpu_ns = median([](const TimedPair& pair) { return pair.bare_cpu_ns; }),
          .ratio = boards::spread_of(ratios),
          .ratio_low = ratios[below],
          .ratio_high = ratios[ratios.size() - 1 - below],
          .pairs = ratios.size()};
}

hal::Result<std::vector<TimedPair>> time_pairs(const boards::OverheadContest& contest,
                                               const PairedOptions& options) {
  const auto calls = calls_for(contest);
  if (!calls) return hal::fail(calls.error());
  std::vector<TimedPair> pairs;
  const auto end = WallClock::now() + std::chrono::duration<double>(options.seconds);
  while ((pairs.size() < options.least || WallClock::now() < end) && !options.stop()) {
    const bool ours_first = pairs.size() % 2 == 0;
    const auto first = one_side(ours_first ? contest.open_ours : contest.open_bare, *calls);
    if (!first) return hal::fail(first.error());
    const auto second = one_side(ours_first ? contest.open_bare : contest.open_ours, *calls);
    if (!second) return hal::fail(second.error());
    const Batch& ours = ours_first ? *first : *second;
    const Batch& bare = ours_first ? *second : *first;
    pairs.push_back({ours.wall_ns, bare.wall_ns, ours.cpu_ns, bare.cpu_ns});
  }
  return pairs;
}

}  // namespace forager::tools
