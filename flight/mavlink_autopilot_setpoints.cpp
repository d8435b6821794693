// What it is to follow: positions, velocities, and on wheels attitude and thrust with the stops that go with
// it.
#include "flight/mavlink_autopilot.hpp"

namespace forager::flight {
namespace {

constexpr std::string_view kSource = "autopilot";
constexpr int kCopies = 3;  // there may be no next update to repeat it
constexpr double kRisen_m = 0.5;

std::uint32_t boot_ms(hal::Instant now) { return static_cast<std::uint32_t>(hal::to_milliseconds(now)); }

mavlink::CommandLong stop_motors() {
  mavlink::CommandLong command;
  command.command = mavlink::command::kArmDisarm;
  command.param2 = mavlink::command::kForceDisarm;
  return command;
}

}  // namespace

// ArduCopter ignores setpoints outside GUIDED without a word; there is no use in sending them then.
void MavlinkAutopilot::send_setpoint(hal::Instant now) {
  if (!deadman_.alive() || !link_.is_open() || !state().link_up || !state().guided) return;
  auto target = setpoint_.due(now);
  if (!target) return;
  target->time_boot_ms = boot_ms(now);
  target->target_system = telemetry_.target_sysid();
  target->target_component = telemetry_.target_compid();
  link_.send(*target, now);
}

void MavlinkAutopilot::set_position(const PositionSetpoint& setpoint) {
  attitude_.clear();
  rolls_at_z_m_.reset();
  if (!setpoint_.set(setpoint)) journal_->note(now_, kSource, "position setpoint is not finite: dropped");
}

void MavlinkAutopilot::set_velocity(const VelocitySetpoint& setpoint) {
  attitude_.clear();
  rolls_at_z_m_.reset();
  if (!setpoint_.set(setpoint)) journal_->note(now_, kSource, "velocity setpoint is not finite: dropped");
}

// Whoever tells this computer, by its own address, to disarm wants everything to stop: the emergency stop of
// a ground station. Nothing else is obeyed.
void MavlinkAutopilot::hear_command(const mavlink::Frame& frame, hal::Instant now) {
  const auto command = mavlink::decode<mavlink::CommandLong>(frame);
  const bool ours = command.target_system == config_.sysid && command.target_component == config_.compid;
  if (!ours || command.command != mavlink::command::kArmDisarm || command.param1 != 0.0F) return;
  if (!stop_heard_) journal_->note(now, kSource, "told to stop at once");
  stop_heard_ = true;
  mavlink::CommandAck ack;
  ack.command = command.command;
  ack.result = mavlink::result::kAccepted;
  ack.target_system = frame.sysid;
  ack.target_component = frame.compid;
  link_.send(ack, now);
}

void MavlinkAutopilot::send_attitude(hal::Instant now) {
  if (!deadman_.alive() || !link_.is_open() || !state().link_up || !state().guided) return;
  auto target = attitude_.due(now);
  if (!target) return;
  target->time_boot_ms = boot_ms(now);
  target->target_system = telemetry_.target_sysid();
  target->target_component = telemetry_.target_compid();
  link_.send(*target, now);
}

void MavlinkAutopilot::set_attitude(const AttitudeSetpoint& setpoint) {
  setpoint_.clear();
  if (!rolls_at_z_m_) rolls_at_z_m_ = state().pose_world.position.z;
  if (!attitude_.set(setpoint)) journal_->note(now_, kSource, "attitude setpoint is not finite: dropped");
}

std::optional<double> MavlinkAutopilot::take_yaw_rate() {
  const auto at = telemetry_.attitude_at();
  if (!at || at == yaw_rate_taken_) return std::nullopt;
  yaw_rate_taken_ = at;
  return telemetry_.yaw_rate_rad_s();
}

void MavlinkAutopilot::request_stop_motors(hal::Instant now) {
  begin("stopping the motors", stop_motors(), now);
}

// "In air" alone is no sign: a land detector takes a vehicle that pushes along the ground for one that flies.
bool MavlinkAutopilot::on_its_wheels() const {
  if (!rolls_at_z_m_ || !state().link_up || !state().guided) return false;
  const bool higher = !state().pose_valid || state().pose_world.position.z - *rolls_at_z_m_ > kRisen_m;
  return !(state().in_air && higher);
}

void MavlinkAutopilot::stop_motors_at_once() {
  request_stop_motors(now_);
  for (int copy = 0; copy < kCopies; ++copy)
    if (telemetry_.has_target()) send_command(stop_motors(), now_);
}

}  // namespace forager::flight
