#include "tools/bench_mission.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "boards/run.hpp"
#include "tools/bench_duel.hpp"

namespace forager::tools {
namespace {

using WallClock = std::chrono::steady_clock;
using boards::Run;

std::uint64_t wall_ns() {
  return static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(WallClock::now().time_since_epoch()).count());
}

struct Flight {
  double simulated_s = 0.0;
  double wall_s = 0.0;
  boards::RunTicks ticks;  // nanoseconds
};

hal::Result<Flight> fly(const boards::Scene& scene, boards::TickCounter counter) {
  const std::uint64_t start = wall_ns();
  boards::RunOptions options;
  options.counter = counter;
  hal::Instant now;
  auto run = Run::prepare(scene, boards::sim_board(), options, now);
  if (!run) return hal::fail(std::move(run).error());
  for (; !(*run)->done(); now += Run::kTick) (*run)->update(now);
  const auto summary = (*run)->summary();
  if (!summary) return hal::fail(summary.error());
  return Flight{summary->sim_time_s, static_cast<double>(wall_ns() - start) * 1e-9, (*run)->ticks()};
}

// Where the time went, in the order of the table.
struct Part {
  const char* name;
  double (*seconds)(const Flight& flight);
};
double loop_s(const Flight& f) { return static_cast<double>(f.ticks.loop) * 1e-9; }
double autopilot_s(const Flight& f) { return static_cast<double>(f.ticks.devices.autopilot) * 1e-9; }
double reader_s(const Flight& f) { return static_cast<double>(f.ticks.devices.reader) * 1e-9; }
double rest_s(const Flight& f) { return std::max(0.0, f.wall_s - loop_s(f) - autopilot_s(f) - reader_s(f)); }
constexpr Part kParts[] = {{"drivers, codecs, decisions, inventory, camera", loop_s},
                           {"emulated reader and air", reader_s},
                           {"emulated autopilot and vehicle", autopilot_s},
                           {"preparing, summing up, clock reading", rest_s}};

// Values of the flight whose wall time is the median: its parts add up, medians of each part would not.
const Flight& middle_of(std::vector<Flight>& flights) {
  const auto middle = flights.begin() + static_cast<std::ptrdiff_t>(flights.size() / 2);
  std::nth_element(flights.begin(), middle, flights.end(),
                   [](const Flight& a, const Flight& b) { return a.wall_s < b.wall_s; });
  return *middle;
}

}  // namespace

hal::Result<std::vector<BenchRow>> bench_mission(const boards::Scene& scene, int repeats) {
  std::vector<double> speeds;
  std::vector<Flight> taken_apart;
  for (int i = 0; i < repeats; ++i) {
    const auto whole = fly(scene, nullptr);
    if (!whole) return hal::fail(whole.error());
    speeds.push_back(whole->simulated_s / whole->wall_s);
    const auto apart = fly(scene, wall_ns);
    if (!apart) return hal::fail(apart.error());
    taken_apart.push_back(*apart);
  }
  const std::string mission = fmt::format("mission {}", scene.name);
  std::vector<BenchRow> rows{{mission, median_of(std::move(speeds)), "sim s/s", "real time", 1.0}};
  const Flight& middle = middle_of(taken_apart);
  for (const Part& part : kParts)
    rows.push_back(
        {fmt::format("{}, {}", mission, part.name), part.seconds(middle), "s", "whole run", middle.wall_s});
  return rows;
}

}  // namespace forager::tools
