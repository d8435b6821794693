#include <algorithm>
#include <cmath>

#include "hal/units.hpp"
#include "mocks/sim_autopilot.hpp"

namespace forager::mocks {
namespace {

using peer::CopterMode;
using peer::Result;

constexpr double kForce = 21196.0;    // arms and disarms whatever the checks say
constexpr double kForceArm = 2989.0;  // ArduPilot's own, for arming only

bool is_mode(double number) {
  constexpr std::array kModes{CopterMode::stabilize, CopterMode::alt_hold, CopterMode::guided,
                              CopterMode::loiter,    CopterMode::rtl,      CopterMode::land,
                              CopterMode::brake};
  return std::ranges::any_of(kModes, [number](CopterMode m) { return number == static_cast<int>(m); });
}

}  // namespace

void SimAutopilot::hear_command(const MavlinkPeerFrame& frame) {
  const MavlinkPayload& m = frame.payload;
  const auto system = m.get<std::uint8_t>(30);
  const auto component = m.get<std::uint8_t>(31);
  if ((system != 0 && system != config_.system) || (component != 0 && component != config_.component)) return;
  Command command;
  command.id = m.get<std::uint16_t>(28);
  command.as_int = frame.id == peer::kCommandInt.id;
  for (std::size_t i = 0; i < 7; ++i) command.param[i] = m.f32(4 * i);
  if (command.as_int) {
    command.param[4] = m.get<std::int32_t>(16);
    command.param[5] = m.get<std::int32_t>(20);
    command.frame = m.get<std::uint8_t>(32);
  }
  const Result result = execute(command);
  say_ack(command.id, result, frame.system, frame.component);
}

Result SimAutopilot::execute(const Command& command) {
  switch (command.id) {
    case peer::kDoSetMode:
      return execute_mode(command);
    case peer::kComponentArmDisarm:
      return execute_arm(command);
    case peer::kNavTakeoff:
      return execute_takeoff(command);
    case peer::kNavLand:
      return set_mode(CopterMode::land) ? Result::accepted : Result::failed;
    case peer::kNavReturnToLaunch:
      return set_mode(CopterMode::rtl) ? Result::accepted : Result::failed;
    case peer::kConditionYaw:
      return execute_yaw(command);
    case peer::kDoChangeSpeed:
      return execute_speed(command);
    case peer::kDoSetServo:
      return execute_servo(command);
    case peer::kSetMessageInterval:
      return execute_interval(command);
    case peer::kGetMessageInterval:
    case peer::kRequestMessage:
      return execute_request(command);
    case peer::kRunPrearmChecks:
      if (armed_) return Result::temporarily_rejected;
      (void)check_arming(true);
      return Result::accepted;
    default:
      return Result::unsupported;
  }
}

Result SimAutopilot::execute_mode(const Command& command) {
  constexpr unsigned kCustomModeEnabled = 1;
  const double flags = command.param[0];
  if (!(flags >= 0.0 && flags <= 255.0) || (static_cast<unsigned>(flags) & kCustomModeEnabled) == 0)
    return Result::denied;
  if (!is_mode(command.param[1])) {
    say_text(peer::kWarning, "No such mode");
    return Result::failed;
  }
  return set_mode(static_cast<CopterMode>(static_cast<int>(command.param[1]))) ? Result::accepted
                                                                               : Result::failed;
}

Result SimAutopilot::execute_arm(const Command& command) {
  const double magic = command.param[1];
  if (command.param[0] == 1.0)
    return arm(magic == kForce || magic == kForceArm) ? Result::accepted : Result::failed;
  if (command.param[0] == 0.0) return disarm(magic == kForce) ? Result::accepted : Result::failed;
  return Result::unsupported;
}

// Height in metres above home; from the ground, in GUIDED, armed.
Result SimAutopilot::execute_takeoff(const Command& command) {
  if (command.as_int && command.frame != peer::kGlobalRelativeAlt) return Result::denied;
  const double height = command.param[6];
  if (mode_ != CopterMode::guided || !armed_ || !landed_ || !estimator_.valid(clock_)) return Result::failed;
  const double top = home_ned_m_.z - height;
  if (!std::isfinite(height) || top >= estimator_.estimate().position_m.z) return Result::failed;
  target_ = hold_here(estimator_.estimate(), clock_);
  target_.kind = GuidedTarget::Kind::takeoff;
  target_.position_ned_m.z = top;
  return Result::accepted;
}

// Angle in degrees clockwise, absolute or relative; rate in degrees/s; -1 left, 1 right, 0 the shorter way.
Result SimAutopilot::execute_yaw(const Command& command) {
  const double angle = command.param[0];
  const double relative = command.param[3];
  if (!(angle >= 0.0 && angle <= 360.0) || (relative != 0.0 && relative != 1.0)) return Result::failed;
  const double present = estimator_.estimate().yaw_rad;
  const double direction = command.param[2];
  double turn = hal::deg_to_rad(angle);
  if (relative != 0.0) {
    if (direction < 0.0) turn = -turn;
  } else {
    turn = hal::wrap_pi(turn - present);
    if (direction < 0.0 && turn > 0.0) turn -= 2.0 * hal::kPi;
    if (direction > 0.0 && turn < 0.0) turn += 2.0 * hal::kPi;
  }
  target_.yaw = GuidedTarget::Yaw::angle;
  target_.yaw_rad = present;
  turn_left_rad_ = turn;
  turn_rate_rad_s_ = command.param[1] > 0.0 ? hal::deg_to_rad(command.param[1]) : 0.0;
  return Result::accepted;
}

Result SimAutopilot::execute_speed(const Command& command) {
  constexpr double kClimb = 2.0;
  constexpr double kDescent = 3.0;
  const double speed = command.param[1];
  if (!(speed > 0.0) || !std::isfinite(speed)) return Result::failed;
  const VehicleParameters& p = vehicle_.parameters();
  if (command.param[0] == kClimb)
    vehicle_.limit_climb(speed, p.max_descent_m_s);
  else if (command.param[0] == kDescent)
    vehicle_.limit_climb(p.max_climb_m_s, speed);
  else
    vehicle_.limit_speed(speed);
  return Result::accepted;
}

Result SimAutopilot::execute_servo(const Command& command) {
  const double output = command.param[0];
  const double pulse_us = command.param[1];
  if (!(output > config_.motors && output <= 16.0) || !(pulse_us >= 0.0 && pulse_us <= 3000.0))
    return Result::failed;
  servo_us_[static_cast<std::size_t>(output) - 1] = static_cast<int>(pulse_us);
  return Result::accepted;
}

SimAutopilot::Stream* SimAutopilot::stream_of(double id) {
  const auto found = std::ranges::find_if(streams_, [id](const Stream& s) { return s.kind->id == id; });
  return found == streams_.end() ? nullptr : &*found;
}

Result SimAutopilot::execute_interval(const Command& command) {
  Stream* stream = stream_of(command.param[0]);
  const double interval_us = command.param[1];
  if (stream == nullptr || !std::isfinite(interval_us)) return Result::denied;
  if (interval_us < 0.0) {
    stream->interval = {};
    return Result::accepted;
  }
  if (interval_us == 0.0) {  // the default: only the heartbeat has one that is not "never"
    stream->interval =
        stream->kind == &peer::kHeartbeat ? hal::Duration(std::chrono::seconds(1)) : hal::Duration{};
    return Result::accepted;
  }
  if (interval_us < 1e6 / (0.8 * config_.loop_rate_hz)) return Result::denied;
  constexpr double kLongestUs = 60e6;  // what GCS_MAVLINK keeps
  stream->interval = hal::from_seconds(std::min(interval_us, kLongestUs) * 1e-6);
  stream->next = clock_ + stream->interval;
  return Result::accepted;
}

Result SimAutopilot::execute_request(const Command& command) {
  const Stream* stream = stream_of(command.param[0]);
  if (stream == nullptr) return Result::failed;
  if (command.id == peer::kRequestMessage) {
    say(*stream->kind);
    return Result::accepted;
  }
  MavlinkPayload p;
  const auto interval_us = std::chrono::duration_cast<std::chrono::microseconds>(stream->interval).count();
  p.put(0, interval_us == 0 ? std::int32_t{-1} : static_cast<std::int32_t>(interval_us));
  p.put(4, static_cast<std::uint16_t>(stream->kind->id));
  link_.send(peer::kMessageInterval, p, now_);
  return Result::accepted;
}

}  // namespace forager::mocks
