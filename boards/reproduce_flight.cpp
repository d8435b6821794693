#include <algorithm>
#include <chrono>

#include "boards/reproduce.hpp"
#include "boards/run.hpp"

namespace forager::boards {
namespace {

constexpr hal::Duration kPatience = std::chrono::hours(2);

}  // namespace

hal::Result<ReproducedFlight> fly_reproduction(const Scene& scene, std::uint64_t seed) {
  hal::Instant now;
  const hal::Instant deadline = now + kPatience;
  RunOptions options;
  options.seed = seed;
  auto run = Run::prepare(scene, sim_board(), options, now);
  if (!run) return hal::fail(std::move(run).error());
  ReproducedFlight flight;
  hal::Instant sample = now;
  const bool no_windows = scene.mission.policy == PolicyKind::dead_reckoning;
  const auto sample_tags = [&] {
    std::size_t tags = (*run)->status().unique_tags;
    // Different tags are counted as windows close; a fixed path has none, but an inventory.
    if (no_windows)
      if (const auto items = (*run)->inventory().items()) tags = items->size();
    flight.tags_each_s.push_back(static_cast<std::uint32_t>(tags));
  };
  for (; !(*run)->done(); now += Run::kTick) {
    if (now > deadline)
      return hal::fail(hal::ErrorCode::timeout, scene.file, "fly", "the mission did not end in two hours");
    (*run)->update(now);
    if (now < sample) continue;
    sample_tags();
    sample += std::chrono::seconds(1);
  }
  const auto summary = (*run)->summary();
  if (!summary) return hal::fail(summary.error());
  // The last window's tags are counted when the mission closes.
  if (!flight.tags_each_s.empty()) flight.tags_each_s.pop_back();
  flight.tags_each_s.push_back(static_cast<std::uint32_t>(summary->tags_read + summary->other_tags_read));
  const double present = static_cast<double>(summary->tags_present.value_or(0));
  if (present > 0.0) flight.coverage_percent = 100.0 * static_cast<double>(summary->tags_read) / present;
  flight.duration_s = summary->sim_time_s;
  flight.end = summary->end;
  flight.crashes = summary->crashes;
  return flight;
}

}  // namespace forager::boards
