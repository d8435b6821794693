#include "tools/run_watch.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "hal/units.hpp"
#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

using Json = nlohmann::ordered_json;

void print_json(const Json& object) {
  const std::string line = object.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  std::fwrite(line.data(), 1, line.size(), stdout);
  std::fflush(stdout);  // whoever follows a run in a pipe wants to see it now
}

// Windows and decisions are on the map and in the table; the report's list is for what happened besides.
bool is_event(std::string_view source, std::string_view text) {
  return !(source == "mission" && text.starts_with("window"));
}

}  // namespace

RunWatch::~RunWatch() { finish(); }

void RunWatch::note(hal::Instant now, std::string_view source, std::string_view text) {
  if (is_event(source, text)) events_.push_back({now, fmt::format("{}: {}", source, text)});
  if (options_.json)
    print_json({{"event", "note"}, {"t_s", hal::to_seconds(now)}, {"source", source}, {"text", text}});
}

void RunWatch::update(const boards::Run& run, hal::Instant now, double wall_time_s) {
  if (now >= next_sample_) {
    ReportData::TagSample sample{
        .at = now, .count = static_cast<std::uint32_t>(run.status().unique_tags), .per_port = {}};
    for (const boards::PortSummary& port : run.ports())
      sample.per_port.push_back(static_cast<std::uint32_t>(std::lround(port.new_tags)));
    samples_.push_back(std::move(sample));
    next_sample_ = now + options_.sample_every;
  }
  if (options_.json) {
    print_decisions(run);
    if (now >= next_json_) {
      next_json_ = now + options_.json_every;
      print_json({{"event", "progress"},
                  {"t_s", hal::to_seconds(now)},
                  {"phase", to_string(run.status().phase)},
                  {"reads", run.status().reads},
                  {"tags", run.status().unique_tags},
                  {"window", run.status().window},
                  {"path_m", run.status().path_m},
                  {"reader", to_string(run.reader_link().phase)}});
    }
  }
  if (options_.progress && wall_time_s >= next_line_wall_s_) print_progress(run, now, wall_time_s);
}

void RunWatch::print_decisions(const boards::Run& run) {
  const auto& decisions = run.status().decisions;
  for (; decisions_told_ < decisions.size(); ++decisions_told_) {
    const flight::Decision& d = decisions[decisions_told_];
    print_json({{"event", "decision"},
                {"t_s", hal::to_seconds(d.at)},
                {"kind", to_string(d.kind)},
                {"x", d.from.position.x},
                {"y", d.from.position.y},
                {"heading_deg", hal::rad_to_deg(d.heading_rad)},
                {"step_m", d.step_m},
                {"new_tags", d.new_tags}});
  }
}

void RunWatch::print_progress(const boards::Run& run, hal::Instant now, double wall_time_s) {
  next_line_wall_s_ = wall_time_s + 0.2;
  const flight::MissionStatus& status = run.status();
  const std::string line = fmt::format("{:7.1f} s  {:<9} {:5} tags  {:7} reads  {:6.1f} m  reader {}",
                                       hal::to_seconds(now), to_string(status.phase), status.unique_tags,
                                       status.reads, status.path_m, to_string(run.reader_link().phase));
  std::fprintf(stderr, "\r%-100s", one_line(line).c_str());
  std::fflush(stderr);
  line_open_ = true;
}

void RunWatch::say(std::string_view text) {
  finish();
  std::fprintf(stderr, "forager: %s\n", one_line(text).c_str());
}

void RunWatch::finish() {
  if (!line_open_) return;
  std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
  line_open_ = false;
}

}  // namespace forager::tools
