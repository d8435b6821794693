#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "hal/units.hpp"
#include "mocks/sim_autopilot.hpp"

namespace forager::mocks {
namespace {

// Parameters that can be read and set, in ArduPilot's units.
struct Parameter {
  std::string_view name;
  double (*read)(const SimAutopilotConfig&, const VehicleParameters&);
};

double seconds(hal::Duration d) { return hal::to_seconds(d); }

constexpr std::array kParameters{
    Parameter{"GUID_TIMEOUT", [](const SimAutopilotConfig& c,
                                 const VehicleParameters&) { return seconds(c.guided_timeout); }},
    Parameter{"WPNAV_SPEED",
              [](const SimAutopilotConfig&, const VehicleParameters& v) { return 100.0 * v.max_speed_m_s; }},
    Parameter{"LAND_SPEED",
              [](const SimAutopilotConfig& c, const VehicleParameters&) { return 100.0 * c.land_speed_m_s; }},
    Parameter{"DISARM_DELAY",
              [](const SimAutopilotConfig& c, const VehicleParameters&) { return seconds(c.disarm_delay); }},
    Parameter{"RTL_ALT",
              [](const SimAutopilotConfig& c, const VehicleParameters&) { return 100.0 * c.rtl_altitude_m; }},
};

// 16 characters, terminated only when shorter.
std::string_view name_at(const MavlinkPayload& m, std::size_t offset, std::array<char, 16>& room) {
  std::memcpy(room.data(), m.bytes(256).data() + offset, room.size());
  const std::string_view all(room.data(), room.size());
  return all.substr(0, all.find('\0'));
}

}  // namespace

void SimAutopilot::hear(const MavlinkPeerFrame& frame) {
  const MavlinkPayload& m = frame.payload;
  switch (frame.id) {
    case peer::kCommandLong.id:
    case peer::kCommandInt.id:
      return hear_command(frame);
    case peer::kSetMode.id: {
      if (m.get<std::uint8_t>(4) != config_.system) return;
      Command command{.id = peer::kDoSetMode};
      command.param[0] = m.get<std::uint8_t>(5);
      command.param[1] = m.get<std::uint32_t>(0);
      return say_ack(static_cast<std::uint16_t>(peer::kSetMode.id), execute_mode(command), frame.system,
                     frame.component);
    }
    case peer::kSetPositionTargetLocalNed.id:
      return hear_setpoint(m);
    case peer::kSetAttitudeTarget.id:
      return hear_attitude(m);
    case peer::kVisionPositionEstimate.id:
      return hear_vision({{m.f32(8), m.f32(12), m.f32(16)}, m.f32(28), m.get<std::uint8_t>(116)});
    case peer::kOdometry.id:
      return hear_odometry(m);
    case peer::kSetGpsGlobalOrigin.id:
      return hear_origin(m);
    case peer::kTimesync.id:
      return hear_timesync(frame);
    case peer::kParamRequestRead.id:
    case peer::kParamSet.id:
      return hear_parameter(frame);
    default:
      return;
  }
}

void SimAutopilot::hear_setpoint(const MavlinkPayload& message) {
  const auto system = message.get<std::uint8_t>(50);
  const auto component = message.get<std::uint8_t>(51);
  if ((system != 0 && system != config_.system) || (component != 0 && component != config_.component)) return;
  const bool heeded = mode_ == peer::CopterMode::guided && in_flight() && !faults_.ignore_setpoints;
  if (!heeded || !decode_guided_target(message, estimator_.estimate(), clock_, target_)) {
    ++setpoints_ignored_;
    return;
  }
  turn_left_rad_ = 0.0;
  ++setpoints_taken_;
}

void SimAutopilot::hear_vision(const VisionSample& sample) {
  if (!hal::is_finite(sample.position_ned_m) || !std::isfinite(sample.yaw_rad)) return;
  if (const auto shift = estimator_.fuse(sample, now_)) shift_targets(*shift);
}

// Only with these frames; any other is ignored without a word (AP_VisualOdom).
void SimAutopilot::hear_odometry(const MavlinkPayload& m) {
  if (m.get<std::uint8_t>(228) != peer::kLocalFrd || m.get<std::uint8_t>(229) != peer::kBodyFrd) return;
  const double w = m.f32(20);
  const double x = m.f32(24);
  const double y = m.f32(28);
  const double z = m.f32(32);
  const double yaw = std::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
  hear_vision({{m.f32(8), m.f32(12), m.f32(16)}, yaw, m.get<std::uint8_t>(230)});
}

void SimAutopilot::hear_origin(const MavlinkPayload& m) {
  const auto latitude = m.get<std::int32_t>(0);
  const auto longitude = m.get<std::int32_t>(4);
  const bool on_earth =
      std::abs(static_cast<double>(latitude)) <= 90e7 && std::abs(static_cast<double>(longitude)) <= 180e7;
  if (m.get<std::uint8_t>(12) != config_.system || !on_earth) return;
  origin_ = {latitude, longitude, m.get<std::int32_t>(8)};
  origin_known_ = true;
  say(peer::kGpsGlobalOrigin);
}

// A request has tc1 = 0; the answer mirrors its ts1 and says the own time.
void SimAutopilot::hear_timesync(const MavlinkPeerFrame& frame) {
  if (frame.payload.get<std::int64_t>(0) != 0) return;
  MavlinkPayload p;
  p.put(0, std::int64_t{(now_ - epoch_).count()});
  p.put(8, frame.payload.get<std::int64_t>(8));
  p.put(16, frame.system);
  p.put(17, frame.component);
  link_.send(peer::kTimesync, p, now_);
}

// An unknown name gets no answer, as in 4.6. Values are floats, integers cast (ArduPilot's way).
void SimAutopilot::hear_parameter(const MavlinkPeerFrame& frame) {
  const bool set = frame.id == peer::kParamSet.id;
  const MavlinkPayload& m = frame.payload;
  if (m.get<std::uint8_t>(set ? 4 : 2) != config_.system) return;
  std::array<char, 16> room{};
  const std::string_view name = name_at(m, set ? 6 : 4, room);
  const double value = m.f32(0);
  if (set && std::isfinite(value)) {
    if (name == "GUID_TIMEOUT") config_.guided_timeout = hal::from_seconds(std::clamp(value, 0.1, 5.0));
    if (name == "WPNAV_SPEED") vehicle_.limit_speed(std::clamp(value, 10.0, 2000.0) / 100.0);
    if (name == "LAND_SPEED") config_.land_speed_m_s = std::clamp(value, 30.0, 200.0) / 100.0;
    if (name == "DISARM_DELAY") config_.disarm_delay = hal::from_seconds(std::clamp(value, 0.0, 127.0));
    if (name == "RTL_ALT") config_.rtl_altitude_m = std::clamp(value, 30.0, 300000.0) / 100.0;
  }
  for (std::size_t i = 0; i < kParameters.size(); ++i) {
    if (kParameters[i].name != name) continue;
    constexpr std::uint8_t kReal32 = 9;
    MavlinkPayload p;
    p.f32(0, kParameters[i].read(config_, vehicle_.parameters()));
    p.put(4, static_cast<std::uint16_t>(kParameters.size()));
    p.put(6, static_cast<std::uint16_t>(i));
    p.text(8, 16, name);
    p.put(24, kReal32);
    link_.send(peer::kParamValue, p, now_);
  }
}

}  // namespace forager::mocks
