#include "tools/run_output.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "hal/units.hpp"
#include "tools/cli_style.hpp"
#include "tools/layout_output.hpp"

namespace forager::tools {
namespace {

using boards::PortSummary;
using boards::RunSummary;

std::string percent_of(std::size_t part, std::size_t whole) {
  return whole == 0 ? std::string("-")
                    : fmt::format("{:.1f} %", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

std::string row(std::string_view name, std::string_view value) {
  return fmt::format("  {:<16}{}\n", name, value);
}

}  // namespace

std::string summary_table(const RunSummary& s, double wall_time_s) {
  std::string out = fmt::format("{} - {}\n", s.scene, one_line(s.title));
  out += row("policy", fmt::format("{}, seed {}, board {}", s.policy, s.seed, one_line(s.board)));
  out += s.tags_present ? row("tags read", fmt::format("{} of {} ({})", s.tags_read, *s.tags_present,
                                                       percent_of(s.tags_read, *s.tags_present)))
                        : row("tags read", fmt::format("{}", s.tags_read));
  if (s.other_tags_read > 0) out += row("other tags", fmt::format("{}", s.other_tags_read));
  if (s.layout) out += row("layout", layout_line(*s.layout));
  out +=
      row("reads", fmt::format("{} ({:.1f} a second of flight)", s.reads,
                               s.flight_time_s > 0.0 ? static_cast<double>(s.reads) / s.flight_time_s : 0.0));
  out += row("time",
             fmt::format("{:.1f} s, {:.1f} s of it in flight; {:.2f} s on the clock ({:.0f} x)", s.sim_time_s,
                         s.flight_time_s, wall_time_s, wall_time_s > 0.0 ? s.sim_time_s / wall_time_s : 0.0));
  out += row("path", fmt::format("{:.1f} m, {} decisions in {} windows", s.path_m, s.decisions, s.windows));
  out += row("ended", s.detail.empty() ? std::string(to_string(s.end))
                                       : fmt::format("{}: {}", to_string(s.end), one_line(s.detail)));
  out += row("link losses", fmt::format("reader {}, autopilot {}", s.reader_losses, s.autopilot_losses));
  if (s.radio_may_be_on) out += row("RADIO", "may still be on: the reader did not confirm its stop");
  if (s.crashes > 0) out += row("CRASHES", fmt::format("{}", s.crashes));
  out += fmt::format("  {:<6}{:<14}{:>9}{:>10}{:>10}\n", "port", "looks", "bearing", "reads", "new tags");
  for (const PortSummary& p : s.ports)
    out += fmt::format("  {:<6}{:<14}{:>8.0f}{}{:>9}{:>10}\n", p.port, one_line(p.name),
                       hal::rad_to_deg(p.bearing_rad), "\u00b0 ", p.reads, p.new_tags);
  return out;
}

std::string summary_json(const RunSummary& s, double wall_time_s) {
  nlohmann::ordered_json j;
  j["event"] = "summary";
  j["scene"] = s.scene;
  j["title"] = s.title;
  j["board"] = s.board;
  j["policy"] = s.policy;
  j["seed"] = s.seed;
  j["tags_present"] = s.tags_present ? nlohmann::ordered_json(*s.tags_present) : nlohmann::ordered_json();
  j["tags_read"] = s.tags_read;
  j["other_tags_read"] = s.other_tags_read;
  j["coverage"] =
      s.tags_present && *s.tags_present > 0
          ? nlohmann::ordered_json(static_cast<double>(s.tags_read) / static_cast<double>(*s.tags_present))
          : nlohmann::ordered_json();
  if (s.layout) j["layout"] = layout_json(*s.layout);
  j["reads"] = s.reads;
  j["sim_time_s"] = s.sim_time_s;
  j["flight_time_s"] = s.flight_time_s;
  j["wall_time_s"] = wall_time_s;
  j["path_m"] = s.path_m;
  j["decisions"] = s.decisions;
  j["windows"] = s.windows;
  j["end_reason"] = std::string(to_string(s.end));
  j["detail"] = s.detail;
  j["reader_losses"] = s.reader_losses;
  j["autopilot_losses"] = s.autopilot_losses;
  j["radio_may_be_on"] = s.radio_may_be_on;
  j["crashes"] = s.crashes;
  j["battery"] = s.battery_fraction ? nlohmann::ordered_json(*s.battery_fraction) : nlohmann::ordered_json();
  j["ports"] = nlohmann::ordered_json::array();
  for (const PortSummary& p : s.ports)
    j["ports"].push_back({{"port", p.port},
                          {"name", p.name},
                          {"bearing_deg", hal::rad_to_deg(p.bearing_rad)},
                          {"reads", p.reads},
                          {"new_tags", p.new_tags}});
  return j.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace forager::tools
