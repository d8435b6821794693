#include "tools/drive_output.hpp"

#include <nlohmann/json.hpp>

#include "hal/units.hpp"
#include "tools/report_markup.hpp"

namespace forager::tools {
namespace {

using boards::DriveFaultSummary;
using boards::DriveResult;
using boards::DriveScene;
using boards::DriveSpread;
using boards::DriveSummary;
using nlohmann::ordered_json;

constexpr std::size_t kMostFailures = 20;

double percent(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

void put_spread(std::string& out, std::string_view name, const DriveSpread& s, int decimals,
                std::string_view unit) {
  put(out, "  {:<18}median {:.{}f}, 99 % below {:.{}f}, worst {:.{}f} {}\n", name, s.median, decimals, s.p99,
      decimals, s.worst, decimals, unit);
}

void put_failure(std::string& out, const DriveResult& run) {
  put(out, "  seed {:<8}{}: {}; {:.2f} m from the goal, heading {:.1f} degrees off, after {:.1f} s\n",
      run.seed, to_string(run.end), run.detail, run.position_error_m, hal::rad_to_deg(run.heading_error_rad),
      run.time_s);
}

ordered_json spread_json(const DriveSpread& s) {
  return {{"median", s.median}, {"p99", s.p99}, {"worst", s.worst}};
}

ordered_json failures_json(const std::vector<DriveResult>& failures) {
  ordered_json list = ordered_json::array();
  for (const DriveResult& run : failures)
    list.push_back({{"seed", run.seed},
                    {"end", to_string(run.end)},
                    {"detail", run.detail},
                    {"position_error_m", run.position_error_m},
                    {"heading_error_deg", hal::rad_to_deg(run.heading_error_rad)},
                    {"time_s", run.time_s},
                    {"reaction_s", run.reaction_s() ? ordered_json(*run.reaction_s()) : ordered_json()}});
  return list;
}

std::string line_of(const ordered_json& json) {
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string drive_table(const DriveScene& scene, const DriveSummary& s, double wall_s) {
  std::string out;
  put(out, "{} - {}\n", scene.name, scene.title);
  put(out, "  {:<18}{} of {} ({:.1f} %) within {:.2f} m and {:.0f} degrees\n", "arrived", s.arrived, s.runs,
      percent(s.arrived, s.runs), scene.steps.goal_margin_m, hal::rad_to_deg(scene.steps.heading_margin_rad));
  put_spread(out, "position error", s.position_m, 3, "m");
  put_spread(out, "heading error", s.heading_deg, 2, "degrees");
  put_spread(out, "time", s.time_s, 1, "s");
  put(out, "  {:<18}{:.1f} ({:.1f} passed rolling), {:.1f} turns, {:.1f} drives, {:.2f} begun anew\n",
      "steps a run", s.steps, s.passed, s.turns, s.drives, s.replans);
  put(out, "  {:<18}{:.1f} touches of a brake, {:.2f} stops for an old pose\n", "a run", s.touches, s.holds);
  put(out, "  {:<18}thrust {:.1f} N s, work {:.1f} J\n", "a run", s.thrust_n_s, s.energy_j);
  put(out, "  {:<18}{} left it and stopped, {} went on outside, {} contacts\n", "corridor", s.left_corridor,
      s.out_without_stop, s.contacts);
  for (const auto& [end, count] : s.ends) put(out, "  {:<18}{} x {}\n", "ended", count, end);
  for (std::size_t i = 0; i < s.failures.size() && i < kMostFailures; ++i) put_failure(out, s.failures[i]);
  if (s.failures.size() > kMostFailures) put(out, "  and {} more\n", s.failures.size() - kMostFailures);
  put(out, "  {:<18}{:.2f} s, {:.1f} ms a run\n", "on the clock", wall_s,
      s.runs == 0 ? 0.0 : 1e3 * wall_s / static_cast<double>(s.runs));
  return out;
}

std::string drive_json(const DriveScene& scene, const DriveSummary& s, double wall_s) {
  ordered_json ends = ordered_json::object();
  for (const auto& [end, count] : s.ends) ends[end] = count;
  return line_of({{"type", "drive"},
                  {"scene", scene.name},
                  {"runs", s.runs},
                  {"arrived", s.arrived},
                  {"position_error_m", spread_json(s.position_m)},
                  {"heading_error_deg", spread_json(s.heading_deg)},
                  {"time_s", spread_json(s.time_s)},
                  {"steps", s.steps},
                  {"steps_passed", s.passed},
                  {"turns", s.turns},
                  {"drives", s.drives},
                  {"replans", s.replans},
                  {"holds", s.holds},
                  {"touches", s.touches},
                  {"thrust_n_s", s.thrust_n_s},
                  {"energy_j", s.energy_j},
                  {"left_corridor", s.left_corridor},
                  {"out_without_stop", s.out_without_stop},
                  {"contacts", s.contacts},
                  {"ends", ends},
                  {"failures", failures_json(s.failures)},
                  {"wall_s", wall_s}});
}

std::string fault_table(const DriveScene& scene, const std::vector<DriveFaultSummary>& faults,
                        double wall_s) {
  std::string out;
  put(out, "{} - faults; safe within {:.0f} ms of detection\n", scene.name,
      1e3 * boards::kDriveReactionBound_s);
  put(out, "  {:<20}{:>6}{:>9}{:>9}{:>7}{:>8}{:>12}{:>11}{:>9}{:>9}\n", "fault", "runs", "noticed", "no harm",
      "else", "unsafe", "reaction ms", "latency s", "way m", "turn");
  for (const DriveFaultSummary& f : faults)
    put(out, "  {:<20}{:>6}{:>9}{:>9}{:>7}{:>8}{:>12.0f}{:>11.2f}{:>9.2f}{:>8.0f}\n", to_string(f.fault),
        f.struck, f.detected, f.harmless, f.ended_else, f.unsafe, 1e3 * f.worst_reaction_s, f.worst_latency_s,
        f.worst_way_m, f.worst_turn_deg);
  put(out,
      "  reaction, latency, way (m) and turn (degrees) are the worst of each kind; way and turn from "
      "detection to "
      "standstill\n");
  for (const DriveFaultSummary& f : faults)
    for (const DriveResult& run : f.failures) {
      put(out, "  {}", to_string(f.fault));
      put_failure(out, run);
    }
  put(out, "  {:<20}{:.2f} s\n", "on the clock", wall_s);
  return out;
}

std::string fault_json(const DriveScene& scene, const std::vector<DriveFaultSummary>& faults, double wall_s) {
  ordered_json list = ordered_json::array();
  for (const DriveFaultSummary& f : faults) {
    ordered_json ends = ordered_json::object();
    for (const auto& [end, count] : f.ends) ends[end] = count;
    list.push_back({{"fault", to_string(f.fault)},
                    {"struck", f.struck},
                    {"detected", f.detected},
                    {"harmless", f.harmless},
                    {"ended_else", f.ended_else},
                    {"unsafe", f.unsafe},
                    {"worst_reaction_s", f.worst_reaction_s},
                    {"worst_latency_s", f.worst_latency_s},
                    {"worst_way_m", f.worst_way_m},
                    {"worst_turn_deg", f.worst_turn_deg},
                    {"ends", ends},
                    {"failures", failures_json(f.failures)}});
  }
  return line_of({{"type", "drive_faults"}, {"scene", scene.name}, {"faults", list}, {"wall_s", wall_s}});
}

}  // namespace forager::tools
