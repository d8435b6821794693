#include <algorithm>
#include <cmath>
#include <limits>

#include "hal/units.hpp"
#include "mocks/sim_autopilot.hpp"

namespace forager::mocks {
namespace {

using peer::CopterMode;

// MAV_MODE_FLAG
constexpr unsigned kCustomMode = 1;
constexpr unsigned kGuidedFlag = 8;
constexpr unsigned kStabilizeFlag = 16;
constexpr unsigned kManualInput = 64;
constexpr unsigned kSafetyArmed = 128;
// MAV_SYS_STATUS_SENSOR: gyros, accelerometers, barometer, vision position, motors, AHRS, battery, pre-arm
constexpr std::uint32_t kSensors = 0x1 | 0x2 | 0x8 | 0x80 | 0x8000 | 0x200000 | 0x2000000;
constexpr std::uint32_t kVisionSensor = 0x80;
constexpr std::uint32_t kPrearmCheck = 0x10000000;
// EKF_STATUS_FLAGS
constexpr std::uint16_t kEkfFlying = 0x1 | 0x2 | 0x4 | 0x8 | 0x10 | 0x20 | 0x100 | 0x200;
constexpr std::uint16_t kEkfLost = 0x1 | 0x4 | 0x20 | 0x80;

constexpr double kMetresPerDegree = 6378137.0 * hal::kPi / 180.0;

// Nearest whole number, held within what the field can say.
template <class T>
T whole(double value) {
  using Limits = std::numeric_limits<T>;
  return static_cast<T>(
      std::lround(std::clamp(value, static_cast<double>(Limits::min()), static_cast<double>(Limits::max()))));
}

std::int16_t centi(double value) { return whole<std::int16_t>(100.0 * value); }

}  // namespace

std::uint32_t SimAutopilot::boot_ms() const {
  return static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::milliseconds>(clock_ - epoch_).count());
}

void SimAutopilot::note(std::string_view text) {
  if (journal_ != nullptr) journal_->note(clock_, "sim-autopilot", text);
}

void SimAutopilot::say(const peer::MessageKind& kind) {
  MavlinkPayload p;
  if (fill(kind, p)) link_.send(kind, p, clock_);
}

void SimAutopilot::say_text(std::uint8_t severity, std::string_view text) {
  MavlinkPayload p;
  const std::size_t size = std::min(text.size(), text_.size());
  std::copy_n(text.begin(), size, text_.begin());
  last_text_ = {text_.data(), size};
  p.put(0, severity);
  p.text(1, 50, last_text_);
  link_.send(peer::kStatustext, p, clock_);
  note(last_text_);
}

void SimAutopilot::say_ack(std::uint16_t command, peer::Result result, std::uint8_t system,
                           std::uint8_t component) {
  MavlinkPayload p;
  p.put(0, command);
  p.put(2, static_cast<std::uint8_t>(result));
  p.put(8, system);
  p.put(9, component);
  link_.send(peer::kCommandAck, p, now_);
}

// False: there is nothing to say yet.
bool SimAutopilot::fill(const peer::MessageKind& kind, MavlinkPayload& p) {
  const bool located = origin_known_ && estimator_.started();
  switch (kind.id) {
    case peer::kHeartbeat.id:
      fill_heartbeat(p);
      return true;
    case peer::kSysStatus.id:
      fill_sys_status(p);
      return true;
    case peer::kSystemTime.id:
      p.put(8, boot_ms());
      return true;
    case peer::kTimesync.id:
      p.put(8, std::int64_t{(clock_ - epoch_).count()});
      return true;
    case peer::kAttitude.id:
      fill_attitude(p);
      return true;
    case peer::kLocalPositionNed.id:
      fill_local_position(p);
      return located;
    case peer::kGlobalPositionInt.id:
      fill_global_position(p);
      return true;
    case peer::kGpsGlobalOrigin.id:
      for (std::size_t i = 0; i < 3; ++i) p.put(4 * i, origin_[i]);
      return origin_known_;
    case peer::kSimState.id:
      fill_sim_state(p);
      return true;
    case peer::kBatteryStatus.id:
      fill_battery(p);
      return true;
    case peer::kAutopilotVersion.id: {
      // MAV_PROTOCOL_CAPABILITY: float parameters, COMMAND_INT, local position targets, MAVLink 2
      p.put(0, std::uint64_t{0x2 | 0x8 | 0x80 | 0x2000});
      p.put(16, std::uint32_t{0x040600FF});  // 4.6.0, official release
      return true;
    }
    case peer::kEkfStatusReport.id:
      fill_ekf(p);
      return true;
    case peer::kExtendedSysState.id:
      fill_extended(p);
      return true;
    default:
      return false;
  }
}

void SimAutopilot::fill_heartbeat(MavlinkPayload& p) const {
  constexpr std::uint8_t kArduPilot = 3;
  constexpr std::uint8_t kMavlinkVersion = 3;
  const bool by_position =
      mode_ != CopterMode::stabilize && mode_ != CopterMode::alt_hold && mode_ != CopterMode::land;
  const unsigned base = kCustomMode | kStabilizeFlag | kManualInput | (by_position ? kGuidedFlag : 0U) |
                        (armed_ ? kSafetyArmed : 0U);
  const int status = failsafe_ ? 5 : landed_ ? 3 : 4;  // MAV_STATE: critical, standby, active
  p.put(0, static_cast<std::uint32_t>(mode_));
  p.put(4, config_.vehicle_type);
  p.put(5, kArduPilot);
  p.put(6, static_cast<std::uint8_t>(base));
  p.put(7, static_cast<std::uint8_t>(status));
  p.put(8, kMavlinkVersion);
}

void SimAutopilot::fill_sys_status(MavlinkPayload& p) {
  std::uint32_t health = kSensors;
  if (!estimator_.healthy(clock_)) health &= ~kVisionSensor;
  if (armed_ || check_arming(false)) health |= kPrearmCheck;
  p.put(0, kSensors | kPrearmCheck);
  p.put(4, kSensors | kPrearmCheck);
  p.put(8, health);
  p.put(14, whole<std::uint16_t>(1000.0 * vehicle_.battery_v()));
  p.put(16, centi(vehicle_.battery_a()));
  p.put(30, static_cast<std::int8_t>(100.0 * vehicle_.battery_fraction()));
}

void SimAutopilot::fill_battery(MavlinkPayload& p) const {
  const double left = vehicle_.battery_fraction();
  p.put(0, static_cast<std::int32_t>(1000.0 * (1.0 - left) * config_.vehicle.capacity_ah));
  p.put(4, std::int32_t{-1});                          // energy: not measured
  p.put(8, std::numeric_limits<std::int16_t>::max());  // temperature: not measured
  for (std::size_t i = 0; i < 10; ++i) p.put(10 + 2 * i, std::numeric_limits<std::uint16_t>::max());
  p.put(10, whole<std::uint16_t>(1000.0 * vehicle_.battery_v()));
  p.put(30, centi(vehicle_.battery_a()));
  p.put(35, static_cast<std::int8_t>(100.0 * left));
  p.put(40, static_cast<std::uint8_t>(left < config_.arming_battery ? 2 : 1));  // charge state: low, ok
}

// Forward, right, down: pitch and yaw change their sign against REP-103.
void SimAutopilot::fill_attitude(MavlinkPayload& p) const {
  const BodyState& body = state();
  p.put(0, boot_ms());
  p.f32(4, body.pose.roll_rad);
  p.f32(8, -body.pose.pitch_rad);
  p.f32(12, estimator_.estimate().yaw_rad);
  p.f32(24, -body.yaw_rate_rad_s - faults_.yaw_drift_rad_s);
}

void SimAutopilot::fill_local_position(MavlinkPayload& p) const {
  const NedEstimate& e = estimator_.estimate();
  p.put(0, boot_ms());
  p.f32(4, e.position_m.x);
  p.f32(8, e.position_m.y);
  p.f32(12, e.position_m.z);
  p.f32(16, e.velocity_m_s.x);
  p.f32(20, e.velocity_m_s.y);
  p.f32(24, e.velocity_m_s.z);
}

void SimAutopilot::fill_global_position(MavlinkPayload& p) const {
  const NedEstimate& e = estimator_.estimate();
  const double latitude_deg = 1e-7 * origin_[0];
  const double north_deg = e.position_m.x / kMetresPerDegree;
  const double east_deg = e.position_m.y / (kMetresPerDegree * std::cos(hal::deg_to_rad(latitude_deg)));
  p.put(0, boot_ms());
  p.put(4, whole<std::int32_t>(origin_[0] + 1e7 * north_deg));
  p.put(8, whole<std::int32_t>(origin_[1] + 1e7 * east_deg));
  p.put(12, whole<std::int32_t>(origin_[2] - 1000.0 * e.position_m.z));
  p.put(16, whole<std::int32_t>(1000.0 * (home_ned_m_.z - e.position_m.z)));
  p.put(20, centi(e.velocity_m_s.x));
  p.put(22, centi(e.velocity_m_s.y));
  p.put(24, centi(e.velocity_m_s.z));
  const double heading_deg = hal::rad_to_deg(e.yaw_rad);
  const double clockwise_deg = heading_deg < 0 ? heading_deg + 360.0 : heading_deg;
  p.put(26, static_cast<std::uint16_t>(whole<std::uint16_t>(100.0 * clockwise_deg) % 36000));
}

// The truth, unlike all others: the world's axes with y and z turned round, 1e-7 degrees left at zero.
void SimAutopilot::fill_sim_state(MavlinkPayload& p) const {
  const BodyState& body = state();
  const hal::Vec3 acceleration = vehicle_.acceleration_world_m_s2();
  const double half = -0.5 * body.pose.yaw_rad;
  p.f32(0, std::cos(half));
  p.f32(12, std::sin(half));
  p.f32(16, body.pose.roll_rad);
  p.f32(20, -body.pose.pitch_rad);
  p.f32(24, -body.pose.yaw_rad);
  p.f32(28, acceleration.x);
  p.f32(32, -acceleration.y);
  p.f32(36, -acceleration.z);
  p.f32(48, -body.yaw_rate_rad_s);
  p.f32(60, body.pose.position.z);
  p.f32(72, body.velocity_world_m_s.x);
  p.f32(76, -body.velocity_world_m_s.y);
  p.f32(80, -body.velocity_world_m_s.z);
}

void SimAutopilot::fill_ekf(MavlinkPayload& p) const {
  const bool valid = estimator_.valid(clock_);
  // A test ratio of 1 is the limit of what the filter believes; assumed values for calm and for lost.
  const double variance = valid && estimator_.healthy(clock_) ? 0.05 : valid ? 0.5 : 1.5;
  p.f32(0, variance);
  p.f32(4, variance);
  p.f32(8, 0.05);
  p.f32(12, 0.05);
  p.put(20, valid ? kEkfFlying : kEkfLost);
}

void SimAutopilot::fill_extended(MavlinkPayload& p) const {
  const bool landing = mode_ == CopterMode::land || (mode_ == CopterMode::rtl && rtl_ == Rtl::land);
  const bool takeoff = mode_ == CopterMode::guided && target_.kind == GuidedTarget::Kind::takeoff;
  // MAV_LANDED_STATE: on ground, landing, take-off, in air
  p.put(1, static_cast<std::uint8_t>(landed_ ? 1 : landing ? 4 : takeoff ? 3 : 2));
}

}  // namespace forager::mocks
