#include "flight/mavlink_autopilot.hpp"

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <iterator>
#include <limits>

#include "flight/frames.hpp"

namespace forager::flight {
namespace {

constexpr std::string_view kSource = "autopilot";
constexpr hal::Duration kOriginPause = 2s;
constexpr int kOriginTries = 5;
constexpr int kHaltCopies = 3;
constexpr std::string_view kGuided = "guided mode";
constexpr std::string_view kLanding = "landing";

mavlink::CommandLong set_mode(std::uint32_t mode) {
  mavlink::CommandLong command;
  command.command = mavlink::command::kDoSetMode;
  command.param1 = mavlink::mode_flag::kCustomMode;
  command.param2 = static_cast<float>(mode);
  return command;
}

mavlink::CommandLong arm_disarm(bool arm) {
  mavlink::CommandLong command;
  command.command = mavlink::command::kArmDisarm;
  command.param1 = arm ? 1.0F : 0.0F;
  return command;
}

hal::Result<> check(const MavlinkConfig& config) {
  const auto positive = [](hal::Duration duration, const char* name) -> hal::Result<> {
    if (duration > hal::Duration::zero()) return {};
    return hal::fail(hal::ErrorCode::invalid_argument, "autopilot", "configure MAVLink",
                     std::string(name) + " is not positive");
  };
  FORAGER_TRY(positive(config.heartbeat_interval, "heartbeat_interval"));
  FORAGER_TRY(positive(config.deadman, "deadman"));
  FORAGER_TRY(positive(config.link_timeout, "link_timeout"));
  FORAGER_TRY(positive(config.pose_timeout, "pose_timeout"));
  FORAGER_TRY(positive(config.setpoint_interval, "setpoint_interval"));
  FORAGER_TRY(positive(config.attitude_interval, "attitude_interval"));
  FORAGER_TRY(positive(config.vision_interval, "vision_interval"));
  FORAGER_TRY(positive(config.command_timeout, "command_timeout"));
  FORAGER_TRY(positive(config.pose_stream_interval, "pose_stream_interval"));
  FORAGER_TRY(positive(config.landed_stream_interval, "landed_stream_interval"));
  FORAGER_TRY(positive(config.battery_stream_interval, "battery_stream_interval"));
  FORAGER_TRY(positive(config.reopen_first, "reopen_first"));
  if (config.command_tries < 1)
    return hal::fail(hal::ErrorCode::invalid_argument, "autopilot", "configure MAVLink",
                     "command_tries is below 1");
  return {};
}

}  // namespace

hal::Result<std::unique_ptr<MavlinkAutopilot>> MavlinkAutopilot::create(hal::ByteStream& stream,
                                                                        hal::Journal& journal,
                                                                        const MavlinkConfig& config,
                                                                        hal::Instant now,
                                                                        MotorAuthority motors) {
  FORAGER_TRY(check(config));
  if (!motors.valid())
    return hal::fail(hal::ErrorCode::invalid_state, "autopilot", "configure MAVLink",
                     "nobody gave it the motors");
  std::optional<mavlink::Signing> signing;
  if (config.signing) {
    auto made = mavlink::Signing::create(config.signing->key, config.signing->link_id,
                                         config.signing->start_timestamp, now);
    if (!made) return hal::fail(std::move(made).error());
    signing = std::move(*made);
  }
  return std::unique_ptr<MavlinkAutopilot>(
      new MavlinkAutopilot(stream, journal, config, std::move(signing), now, std::move(motors)));
}

MavlinkAutopilot::MavlinkAutopilot(hal::ByteStream& stream, hal::Journal& journal,
                                   const MavlinkConfig& config, std::optional<mavlink::Signing> signing,
                                   hal::Instant now, MotorAuthority motors)
    : motors_(std::move(motors)),
      journal_(&journal),
      config_(config),
      link_(stream, journal, config, std::move(signing)),
      telemetry_(config, journal),
      request_(config),
      streams_(config),
      setpoint_(config.setpoint_interval),
      attitude_(config.attitude_interval),
      servos_(config),
      deadman_(config.deadman),
      now_(now) {}

void MavlinkAutopilot::update(hal::Instant now) {
  now_ = now;
  link_.service(now);
  link_.receive(now, [&](const mavlink::Frame& frame) { hear(frame, now); });
  if (telemetry_.update(now)) {
    streams_.restart();  // it may have rebooted
    servos_.forget();
    origin_known_ = false;
    origin_tries_ = 0;
    next_origin_.reset();
  }
  if (deadman_.update(now)) {
    clear_setpoint();
    journal_->note(now, kSource, "deadman expired: heartbeats and setpoints stop");
  }
  if (attitude_.update(now)) journal_->note(now, kSource, "attitude setpoint ran out");
  if (setpoint_.update(now)) journal_->note(now, kSource, "setpoint ran out");
  // Whoever has it now, or who had it meanwhile, may have flown it away.
  if (!state().guided || !state().armed) rolls_at_z_m_.reset();
  request_.update(state(), telemetry_.last_warning(), now);
  send_heartbeat(now);
  send_requests(now);
  send_streams_and_origin(now);
  send_setpoint(now);
  send_attitude(now);
  note_outcome(now);
}

void MavlinkAutopilot::send(hal::Instant now) {
  send_requests(now);
  send_setpoint(now);
  send_attitude(now);
}

void MavlinkAutopilot::hear(const mavlink::Frame& frame, hal::Instant now) {
  if (frame.id == mavlink::CommandLong::kId) return hear_command(frame, now);
  if (!telemetry_.take(frame, now)) return;
  streams_.heard(frame.id, now);
  switch (frame.id) {
    case mavlink::CommandAck::kId: {
      const auto ack = mavlink::decode<mavlink::CommandAck>(frame);
      if (is_for_us(ack.target_system, ack.target_component)) {
        request_.take(ack, now);
        servos_.take(ack);
      }
      break;
    }
    case mavlink::Timesync::kId:
      answer_timesync(frame, now);
      break;
    case mavlink::GpsGlobalOrigin::kId:
      origin_known_ = true;
      break;
    default:
      break;
  }
}

// Zero means "everybody" and is what MAVLink 1 and old senders give.
bool MavlinkAutopilot::is_for_us(std::uint8_t sysid, std::uint8_t compid) const {
  return (sysid == 0 || sysid == config_.sysid) && (compid == 0 || compid == config_.compid);
}

void MavlinkAutopilot::answer_timesync(const mavlink::Frame& frame, hal::Instant now) {
  auto sync = mavlink::decode<mavlink::Timesync>(frame);
  if (sync.tc1 != 0 || !is_for_us(sync.target_system, sync.target_component)) return;
  if (deadman_.state() == Deadman::State::unfed) return;
  sync.tc1 = now.time_since_epoch().count();
  sync.target_system = frame.sysid;
  sync.target_component = frame.compid;
  link_.send(sync, now);
}

void MavlinkAutopilot::send_heartbeat(hal::Instant now) {
  if (!deadman_.alive()) {
    next_heartbeat_.reset();
    return;
  }
  if (!link_.is_open() || (next_heartbeat_ && now < *next_heartbeat_)) return;
  next_heartbeat_ = now + config_.heartbeat_interval;
  mavlink::Heartbeat heartbeat;
  heartbeat.type = mavlink::vehicle_type::kOnboardController;
  heartbeat.autopilot = mavlink::autopilot_type::kInvalid;
  heartbeat.system_status = mavlink::system_state::kActive;
  heartbeat.mavlink_version = mavlink::kProtocolVersion;
  link_.send(heartbeat, now);
}

void MavlinkAutopilot::send_command(mavlink::CommandLong command, hal::Instant now) {
  command.target_system = telemetry_.target_sysid();
  command.target_component = telemetry_.target_compid();
  link_.send(command, now);
}

// Without a known autopilot a try passes unsent: better a refusal in the end than waiting for ever.
void MavlinkAutopilot::send_requests(hal::Instant now) {
  const mavlink::CommandLong* const command = request_.due(now);
  if (command != nullptr && telemetry_.has_target()) send_command(*command, now);
  servos_.set_link(link_.is_open() && state().link_up);
  if (const auto servo = servos_.due(now)) send_command(*servo, now);
}

void MavlinkAutopilot::send_streams_and_origin(hal::Instant now) {
  if (!deadman_.alive() || !link_.is_open() || !state().link_up) return;
  if (const auto ask = streams_.due(now)) send_command(*ask, now);

  const bool origin_due = config_.origin && !origin_known_ && origin_tries_ < kOriginTries;
  if (!origin_due || (next_origin_ && now < *next_origin_)) return;
  next_origin_ = now + kOriginPause;
  ++origin_tries_;
  mavlink::SetGpsGlobalOrigin origin;
  origin.target_system = telemetry_.target_sysid();
  origin.latitude = static_cast<std::int32_t>(std::lround(config_.origin->latitude_deg * 1e7));
  origin.longitude = static_cast<std::int32_t>(std::lround(config_.origin->longitude_deg * 1e7));
  origin.altitude = static_cast<std::int32_t>(std::lround(config_.origin->altitude_m * 1e3));
  origin.time_usec = static_cast<std::uint64_t>(now.time_since_epoch().count() / 1000);
  link_.send(origin, now);
}

void MavlinkAutopilot::begin(std::string_view what, const mavlink::CommandLong& command, hal::Instant now) {
  request_.begin(what, command, now);
  noted_ = RequestState::pending;
  fmt::memory_buffer line;
  fmt::format_to(std::back_inserter(line), "{} requested", what);
  journal_->note(now, kSource, {line.data(), line.size()});
}

void MavlinkAutopilot::begin_mode(std::string_view what, std::uint32_t mode, hal::Instant now) {
  begin(what, set_mode(mode), now);
}

void MavlinkAutopilot::request_guided(hal::Instant now) { begin_mode(kGuided, config_.guided_mode, now); }
void MavlinkAutopilot::request_land(hal::Instant now) { begin_mode(kLanding, config_.land_mode, now); }
void MavlinkAutopilot::request_arm(hal::Instant now) { begin("arming", arm_disarm(true), now); }
void MavlinkAutopilot::request_disarm(hal::Instant now) { begin("disarming", arm_disarm(false), now); }

void MavlinkAutopilot::request_takeoff(double height_m, hal::Instant now) {
  if (!std::isfinite(height_m) || height_m <= 0.0) {
    request_.refuse("take-off", "the height is not positive");
    noted_ = RequestState::pending;
    return note_outcome(now);
  }
  rolls_at_z_m_.reset();
  mavlink::CommandLong command;
  command.command = mavlink::command::kNavTakeoff;
  command.param7 = static_cast<float>(height_m);  // above home
  begin("take-off", command, now);
}

void MavlinkAutopilot::note_outcome(hal::Instant now) {
  if (request_.state() == noted_) return;
  noted_ = request_.state();
  fmt::memory_buffer line;
  if (noted_ == RequestState::accepted)
    fmt::format_to(std::back_inserter(line), "{} accepted", request_.what());
  else
    fmt::format_to(std::back_inserter(line), "{}", request_.detail());
  journal_->note(now, kSource, {line.data(), line.size()});
}

void MavlinkAutopilot::send_vision(const hal::PoseSample& sample) {
  const hal::Pose ned = flip_pose(sample.pose);
  if (!hal::is_finite(ned.position) || !hal::is_finite(hal::Vec3{ned.roll_rad, ned.pitch_rad, ned.yaw_rad}))
    return;
  if (deadman_.state() == Deadman::State::unfed) return;
  if (last_vision_ && sample.stamp - *last_vision_ < config_.vision_interval) return;
  last_vision_ = sample.stamp;
  mavlink::VisionPositionEstimate vision;
  vision.usec = static_cast<std::uint64_t>(sample.stamp.time_since_epoch().count() / 1000);
  vision.x = static_cast<float>(ned.position.x);
  vision.y = static_cast<float>(ned.position.y);
  vision.z = static_cast<float>(ned.position.z);
  vision.roll = static_cast<float>(ned.roll_rad);
  vision.pitch = static_cast<float>(ned.pitch_rad);
  vision.yaw = static_cast<float>(ned.yaw_rad);
  vision.covariance[0] = std::numeric_limits<float>::quiet_NaN();  // unknown
  vision.reset_counter = sample.reset_counter;
  link_.send(vision, now_);
}

void MavlinkAutopilot::halt() noexcept {
  try {
    clear_setpoint();
    if (on_its_wheels()) return stop_motors_at_once();
    const bool pending = request_.state() == RequestState::pending;
    if (pending && request_.what() == kLanding) return;
    if (!state().guided && !(pending && request_.what() == kGuided)) return;
    request_land(now_);
    // There may be no next update to repeat it.
    for (int copy = 0; copy < kHaltCopies; ++copy)
      if (telemetry_.has_target()) send_command(set_mode(config_.land_mode), now_);
  } catch (const std::exception&) {  // out of memory: the autopilot's own time-outs remain
    setpoint_.clear();
  }
}

}  // namespace forager::flight
