#include "tools/drive_hybrid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "boards/hybrid_run.hpp"
#include "boards/run_journal.hpp"
#include "tools/cli_style.hpp"
#include "tools/stop_signal.hpp"

namespace forager::tools {
namespace {

using Json = nlohmann::ordered_json;

// Over all runs of a scene.
struct Totals {
  std::uint64_t runs = 0;
  std::uint64_t arrived = 0;
  std::uint64_t hops = 0;
  double worst_position_m = 0.0;
  double least_over_m = std::numeric_limits<double>::infinity();
  double least_side_m = std::numeric_limits<double>::infinity();
  double time_s = 0.0;
  double airborne_s = 0.0;
  double rolled_m = 0.0;
  double flown_m = 0.0;
  std::map<std::string, std::uint64_t> ends;

  void add(const boards::HybridResult& result, bool good) {
    ++runs;
    arrived += good ? 1U : 0U;
    hops += result.hops;
    worst_position_m = std::max(worst_position_m, result.position_error_m);
    least_over_m = std::min(least_over_m, result.over_clearance_m);
    least_side_m = std::min(least_side_m, result.side_clearance_m);
    time_s += result.time_s;
    airborne_s += result.airborne_s;
    rolled_m += result.rolled_m;
    flown_m += result.flown_m;
    if (!good)
      ++ends[fmt::format("seed {}: {} {}{}", result.seed, to_string(result.end), result.detail,
                         result.braked_in_air ? "" : ", a brake opened in the air")];
  }
  [[nodiscard]] double mean(double sum) const {
    return sum / static_cast<double>(std::max<std::uint64_t>(runs, 1));
  }
};

// JSON knows no infinity.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string metres(double value) { return std::isfinite(value) ? fmt::format("{:.2f} m", value) : "none"; }

std::string as_json(const boards::HybridScene& scene, const flight::HybridRoute& route, const Totals& t) {
  Json failures = Json::array();
  for (const auto& [what, count] : t.ends) failures.push_back(what);
  const Json line = {{"scene", scene.drive.name},
                     {"runs", t.runs},
                     {"arrived", t.arrived},
                     {"hops", t.hops},
                     {"worst_position_m", t.worst_position_m},
                     {"least_over_m", number(t.least_over_m)},
                     {"least_side_m", number(t.least_side_m)},
                     {"mean_time_s", t.mean(t.time_s)},
                     {"mean_airborne_s", t.mean(t.airborne_s)},
                     {"mean_rolled_m", t.mean(t.rolled_m)},
                     {"mean_flown_m", t.mean(t.flown_m)},
                     {"route", boards::describe_route(scene, route)},
                     {"failures", failures}};
  return line.dump() + "\n";
}

std::string as_text(const boards::HybridScene& scene, const flight::HybridRoute& route, const Totals& t) {
  std::string text = fmt::format("{}: {}\n", one_line(scene.drive.name), one_line(scene.drive.title));
  for (const std::string& line : boards::describe_route(scene, route)) text += "  " + line + "\n";
  text += fmt::format("arrived            {} of {} runs\n", t.arrived, t.runs);
  text += fmt::format("hops landed        {}\n", t.hops);
  text += fmt::format("worst place        {}\n", metres(t.worst_position_m));
  text += fmt::format("least above        {}\n", metres(t.least_over_m));
  text += fmt::format("least beside       {}\n", metres(t.least_side_m));
  text += fmt::format("mean time          {:.1f} s, {:.1f} s of it in the air\n", t.mean(t.time_s),
                      t.mean(t.airborne_s));
  text += fmt::format("mean way           {:.2f} m rolled, {:.2f} m flown\n", t.mean(t.rolled_m),
                      t.mean(t.flown_m));
  for (const auto& [what, count] : t.ends) text += fmt::format("  {}\n", one_line(what));
  return text;
}

}  // namespace

int run_hybrid_drive(const HybridDriveCommand& command) {
  const auto scene = boards::load_hybrid_scene(command.scene);
  if (!scene) return complain(scene.error());
  const auto journal = boards::RunJournal::open(command.journal, {});
  if (!journal) return complain(journal.error());
  const StopSignal signals;
  Totals totals;
  flight::HybridRoute route;
  for (std::uint64_t i = 0; i < command.runs && !StopSignal::raised(); ++i) {
    boards::HybridRunOptions options;
    options.seed = command.seed + i;
    options.journal = i == 0 && !command.journal.empty() ? journal->get() : nullptr;
    auto result = boards::run_hybrid(*scene, options);
    if (!result) return complain(result.error());
    totals.add(*result, result->arrived(*scene));
    route = std::move(result->route);
  }
  if (!command.journal.empty() && !(*journal)->flush())
    return complain(
        {hal::ErrorCode::io, command.journal, "write", "could not be written", "Check the disk.", 0});
  const std::string text = command.json ? as_json(*scene, route, totals) : as_text(*scene, route, totals);
  if (const auto written = write_output("-", text); !written) return complain(written.error());
  if (StopSignal::raised()) return kExitFailure;
  const double enough = command.least_arrived * static_cast<double>(command.runs);
  return static_cast<double>(totals.arrived) >= enough ? kExitDone : kExitCheckFailed;
}

}  // namespace forager::tools
