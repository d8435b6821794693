#include "tools/mavlink_output.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "flight/mavlink/registry.hpp"

namespace forager::tools {
namespace {

using Json = nlohmann::ordered_json;
using flight::MavlinkMonitor;
using flight::mavlink::Frame;

double rounded(double value) { return std::round(value * 10.0) / 10.0; }

double seconds_of(const MavlinkMoment& moment, bool whole) {
  return hal::to_seconds(whole ? moment.now.time_since_epoch() : moment.interval);
}

double rate(const MavlinkMonitor::Traffic& it, bool whole, double seconds) {
  return static_cast<double>(whole ? it.frames : it.interval_frames) / seconds;
}

double loss_percent(const MavlinkMoment& moment, const MavlinkMonitor::Traffic& it) {
  const auto* peer = moment.link.sequence_stats().find(it.sysid, it.compid);
  return peer == nullptr ? 0.0 : 100.0 * peer->loss_fraction();
}

bool is_armed(const MavlinkMonitor::Component& it) {
  return (it.heartbeat.base_mode & flight::mavlink::mode_flag::kSafetyArmed) != 0;
}

std::string battery_text(const MavlinkMonitor::Component& it) {
  std::string text;
  if (it.battery_volts) text += fmt::format(", battery {:.1f} V", *it.battery_volts);
  if (it.battery_percent)
    text += fmt::format("{} {} %", text.empty() ? ", battery" : "", *it.battery_percent);
  return text;
}

std::string component_text(const MavlinkMonitor::Component& it, hal::Instant now) {
  const bool autopilot = it.heartbeat.autopilot != flight::mavlink::autopilot_type::kInvalid;
  std::string text =
      fmt::format("{}/{} {}, {}", it.sysid, it.compid, flight::autopilot_text(it.heartbeat.autopilot),
                  flight::vehicle_text(it.heartbeat.type));
  if (autopilot)
    text += fmt::format(", {}, {}{}", flight::mode_text(it.heartbeat), is_armed(it) ? "ARMED" : "disarmed",
                        battery_text(it));
  return text + fmt::format(", heartbeat {:.1f} s ago", hal::to_seconds(now - it.last_heartbeat));
}

std::vector<std::string> table_of(const MavlinkMoment& moment, bool whole) {
  const double seconds = seconds_of(moment, whole);
  std::vector<std::string> lines;
  for (const auto& it : moment.monitor.components()) lines.push_back(component_text(it, moment.now));
  if (moment.monitor.traffic().empty()) return lines;
  lines.push_back(fmt::format("{:<8} {:>6}  {:<28} {:>8} {:>9} {:>9} {:>7}  {}", "from", "id", "message",
                              "1/s", "frames", "bytes/s", "loss", "last"));
  for (const auto& it : moment.monitor.traffic())
    lines.push_back(fmt::format(
        "{:<8} {:>6}  {:<28} {:>8.1f} {:>9} {:>9.0f} {:>5.1f} %  {:.1f} s ago",
        fmt::format("{}/{}", it.sysid, it.compid), it.id, it.name, rate(it, whole, seconds), it.frames,
        rate(it, whole, seconds) * static_cast<double>(it.bytes) / static_cast<double>(it.frames),
        loss_percent(moment, it), hal::to_seconds(moment.now - it.last)));
  return lines;
}

std::string parser_text(const MavlinkMoment& moment) {
  const auto& parser = moment.link.parser_stats();
  return fmt::format(
      "{} bytes: {} frames, {} of messages not known here, {} with a wrong checksum, {} bytes in no frame",
      parser.bytes, parser.frames, parser.unknown, parser.bad_crc, parser.skipped_bytes);
}

Json json_of(const MavlinkMoment& moment, bool whole) {
  const double seconds = seconds_of(moment, whole);
  Json components = Json::array();
  for (const auto& it : moment.monitor.components())
    components.push_back({{"sysid", it.sysid},
                          {"compid", it.compid},
                          {"type", flight::vehicle_text(it.heartbeat.type)},
                          {"autopilot", flight::autopilot_text(it.heartbeat.autopilot)},
                          {"mode", flight::mode_text(it.heartbeat)},
                          {"armed", is_armed(it)},
                          {"version", it.version == flight::mavlink::Version::v1 ? 1 : 2},
                          {"signed", it.is_signed},
                          {"battery_percent", it.battery_percent ? Json(*it.battery_percent) : Json(nullptr)},
                          {"battery_v", it.battery_volts ? Json(*it.battery_volts) : Json(nullptr)},
                          {"age_s", rounded(hal::to_seconds(moment.now - it.last_heartbeat))}});
  Json messages = Json::array();
  for (const auto& it : moment.monitor.traffic())
    messages.push_back({{"sysid", it.sysid},
                        {"compid", it.compid},
                        {"id", it.id},
                        {"name", it.name},
                        {"rate_hz", rounded(rate(it, whole, seconds))},
                        {"frames", it.frames},
                        {"loss_percent", rounded(loss_percent(moment, it))},
                        {"age_s", rounded(hal::to_seconds(moment.now - it.last))}});
  const auto& parser = moment.link.parser_stats();
  return {{"event", whole ? "end" : "traffic"},
          {"t_s", hal::to_seconds(moment.now)},
          {"bytes", parser.bytes},
          {"frames", parser.frames},
          {"unknown", parser.unknown},
          {"bad_crc", parser.bad_crc},
          {"why_none", moment.why.empty() ? Json(nullptr) : Json(moment.why)},
          {"components", components},
          {"messages", messages}};
}

std::string hex_of(const Frame& frame) {
  std::string hex;
  for (const std::byte byte : frame.bytes) hex += fmt::format("{:02x}", static_cast<unsigned>(byte));
  return hex;
}

std::string_view name_of(const Frame& frame) {
  const auto* known = flight::mavlink::find_message(frame.id);
  return known != nullptr ? known->name : "?";
}

}  // namespace

void MavlinkOutput::note(hal::Instant now, std::string_view source, std::string_view text) {
  out_.record({{"event", "note"}, {"t_s", hal::to_seconds(now)}, {"source", source}, {"text", text}});
  out_.line(fmt::format("{:9.1f} s  {}: {}", hal::to_seconds(now), source, text));
}

void MavlinkOutput::raw(hal::Instant now, const Frame& frame) {
  const int version = frame.version == flight::mavlink::Version::v1 ? 1 : 2;
  out_.record({{"event", "frame"},
               {"t_s", hal::to_seconds(now)},
               {"sysid", frame.sysid},
               {"compid", frame.compid},
               {"sequence", frame.sequence},
               {"version", version},
               {"name", name_of(frame)},
               {"hex", hex_of(frame)}});
  out_.line(fmt::format("{:9.3f} s  {}/{} #{:<3} v{} {:<24} {}", hal::to_seconds(now), frame.sysid,
                        frame.compid, frame.sequence, version, name_of(frame), hex_of(frame)));
}

void MavlinkOutput::moment(const MavlinkMoment& moment) {
  out_.record(json_of(moment, false));
  if (out_.json()) return;
  if (live_) {
    auto lines = table_of(moment, false);
    lines.insert(lines.begin(),
                 fmt::format("{:.1f} s  {}", hal::to_seconds(moment.now), parser_text(moment)));
    if (!moment.why.empty()) lines.push_back("none: " + moment.why);
    return out_.live(lines);
  }
  std::string line =
      fmt::format("{:9.1f} s  {:5} frames", hal::to_seconds(moment.now), moment.monitor.interval_frames());
  if (const auto* autopilot = moment.monitor.autopilot())
    line += "  " + component_text(*autopilot, moment.now);
  out_.line(line);
  if (moment.why != last_why_ && !moment.why.empty()) out_.line("             none: " + moment.why);
  last_why_ = moment.why;
}

void MavlinkOutput::end(const MavlinkMoment& moment) {
  out_.record(json_of(moment, true));
  if (out_.json()) return;
  out_.line(fmt::format("in {:.1f} s, {}", hal::to_seconds(moment.now), parser_text(moment)));
  for (const std::string& line : table_of(moment, true)) out_.line(line);
}

}  // namespace forager::tools
