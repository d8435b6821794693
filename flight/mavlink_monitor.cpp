#include "flight/mavlink_monitor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "flight/mavlink/codec.hpp"
#include "flight/mavlink/messages.hpp"
#include "flight/mavlink/registry.hpp"

namespace forager::flight {
namespace {

template <class Number>
using Names = std::pair<Number, std::string_view>;

// ArduCopter 4.6, Mode::Number.
constexpr std::array<Names<std::uint32_t>, 26> kCopterModes{
    {{0, "STABILIZE"}, {1, "ACRO"},        {2, "ALT_HOLD"},      {3, "AUTO"},        {4, "GUIDED"},
     {5, "LOITER"},    {6, "RTL"},         {7, "CIRCLE"},        {9, "LAND"},        {11, "DRIFT"},
     {13, "SPORT"},    {14, "FLIP"},       {15, "AUTOTUNE"},     {16, "POSHOLD"},    {17, "BRAKE"},
     {18, "THROW"},    {19, "AVOID_ADSB"}, {20, "GUIDED_NOGPS"}, {21, "SMART_RTL"},  {22, "FLOWHOLD"},
     {23, "FOLLOW"},   {24, "ZIGZAG"},     {25, "SYSTEMID"},     {26, "AUTOROTATE"}, {27, "AUTO_RTL"},
     {28, "TURTLE"}}};

// MAV_TYPE and MAV_AUTOPILOT of common.xml, as far as they are met here.
constexpr std::array<Names<std::uint8_t>, 15> kVehicles{{{0, "generic vehicle"},
                                                         {1, "fixed wing"},
                                                         {2, "quadrotor"},
                                                         {3, "coaxial helicopter"},
                                                         {4, "helicopter"},
                                                         {5, "antenna tracker"},
                                                         {6, "ground station"},
                                                         {10, "ground rover"},
                                                         {11, "surface boat"},
                                                         {13, "hexarotor"},
                                                         {14, "octorotor"},
                                                         {15, "tricopter"},
                                                         {18, "onboard controller"},
                                                         {26, "gimbal"},
                                                         {30, "camera"}}};
constexpr std::array<Names<std::uint8_t>, 4> kAutopilots{
    {{0, "generic autopilot"}, {3, "ArduPilot"}, {8, "no autopilot"}, {12, "PX4"}}};

template <class Table, class Number>
std::string name_in(const Table& table, Number number, std::string_view otherwise) {
  const auto found = std::ranges::find(table, number, &Names<Number>::first);
  return found != table.end() ? std::string(found->second) : fmt::format("{} {}", otherwise, number);
}

bool is_copter(std::uint8_t type) { return (type >= 2 && type <= 4) || (type >= 13 && type <= 15); }

}  // namespace

std::string mode_text(const mavlink::Heartbeat& heartbeat) {
  if (heartbeat.autopilot == mavlink::autopilot_type::kArdupilot && is_copter(heartbeat.type))
    return name_in(kCopterModes, heartbeat.custom_mode, "mode");
  return fmt::format("mode {}", heartbeat.custom_mode);
}

std::string vehicle_text(std::uint8_t mav_type) { return name_in(kVehicles, mav_type, "type"); }

std::string autopilot_text(std::uint8_t mav_autopilot) {
  return name_in(kAutopilots, mav_autopilot, "autopilot");
}

std::optional<std::string> MavlinkMonitor::take(const mavlink::Frame& frame, hal::Instant now) {
  const auto key = [](const Traffic& it) { return std::tuple{it.sysid, it.compid, it.id}; };
  const std::tuple wanted{frame.sysid, frame.compid, frame.id};
  auto at = std::ranges::lower_bound(traffic_, wanted, {}, key);
  if (at == traffic_.end() || key(*at) != wanted) {
    const mavlink::MessageInfo* const known = mavlink::find_message(frame.id);
    at = traffic_.insert(at, {frame.sysid, frame.compid, frame.id,
                              known != nullptr ? known->name : std::string_view("?"), 0, 0, 0, now});
  }
  ++at->frames;
  ++at->interval_frames;
  ++interval_frames_;
  at->bytes += frame.bytes.size();
  at->last = now;
  if (frame.id == mavlink::Heartbeat::kId) take_heartbeat(frame, now);
  if (frame.id == mavlink::SysStatus::kId || frame.id == mavlink::BatteryStatus::kId) take_battery(frame);
  if (frame.id != mavlink::Statustext::kId) return std::nullopt;
  const auto text = mavlink::decode<mavlink::Statustext>(frame);
  const auto end = std::ranges::find(text.text, '\0');
  return fmt::format("[{}] {}", text.severity, std::string_view(text.text.begin(), end));
}

MavlinkMonitor::Component* MavlinkMonitor::component(std::uint8_t sysid, std::uint8_t compid) {
  const auto found = std::ranges::find_if(
      components_, [&](const Component& it) { return it.sysid == sysid && it.compid == compid; });
  return found == components_.end() ? nullptr : &*found;
}

void MavlinkMonitor::take_heartbeat(const mavlink::Frame& frame, hal::Instant now) {
  Component* known = component(frame.sysid, frame.compid);
  if (known == nullptr) known = &components_.emplace_back();
  known->sysid = frame.sysid;
  known->compid = frame.compid;
  known->heartbeat = mavlink::decode<mavlink::Heartbeat>(frame);
  known->version = frame.version;
  known->is_signed = frame.is_signed();
  known->last_heartbeat = now;
}

void MavlinkMonitor::take_battery(const mavlink::Frame& frame) {
  Component* const owner = component(frame.sysid, frame.compid);
  if (owner == nullptr) return;
  const auto take_percent = [owner](int percent) {
    if (percent >= 0) owner->battery_percent = percent;  // negative: it does not know
  };
  if (frame.id == mavlink::SysStatus::kId) {
    const auto status = mavlink::decode<mavlink::SysStatus>(frame);
    take_percent(status.battery_remaining);
    if (status.voltage_battery != 0xFFFF) owner->battery_volts = status.voltage_battery / 1000.0;
  } else {
    const auto status = mavlink::decode<mavlink::BatteryStatus>(frame);
    if (status.id == 0) take_percent(status.battery_remaining);
  }
}

void MavlinkMonitor::next_interval() {
  for (Traffic& it : traffic_) it.interval_frames = 0;
  interval_frames_ = 0;
}

const MavlinkMonitor::Component* MavlinkMonitor::autopilot() const {
  const auto found = std::ranges::find_if(components_, [](const Component& it) {
    return it.heartbeat.autopilot != mavlink::autopilot_type::kInvalid;
  });
  return found == components_.end() ? nullptr : &*found;
}

std::string why_silent(const MavlinkSilence& facts) {
  const mavlink::ParserStats& parser = facts.parser;
  if (!facts.link_open)
    return facts.link_problem.empty() ? "the link is not open yet"
                                      : "the link is down: " + facts.link_problem;
  if (parser.bytes == 0)
    return facts.serial
               ? "not a byte has come: autopilot off, RX and TX swapped, or its port does not speak MAVLink "
                 "(SERIALn_PROTOCOL)"
               : "nothing has come: autopilot off, another address or port, or another program has its "
                 "answers";
  if (parser.frames == 0 && parser.bad_crc > 0)
    return "frames come with wrong checksums: noise, or a dialect that is not known here";
  if (parser.frames == 0 && parser.unknown == 0)
    return fmt::format("{} bytes have come and no frame of MAVLink is among them: {}", parser.bytes,
                       facts.serial ? "another baud rate, or another protocol" : "another protocol");
  if (!facts.autopilot_heard) return "frames come, and no heartbeat of an autopilot is among them";
  return "it was heard before and has fallen silent";
}

}  // namespace forager::flight
