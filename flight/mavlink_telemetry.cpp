#include "flight/mavlink_telemetry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "flight/frames.hpp"

namespace forager::flight {
namespace {

constexpr std::string_view kSource = "autopilot";
constexpr std::size_t kMaxText = 256;

}  // namespace

MavlinkTelemetry::MavlinkTelemetry(const MavlinkConfig& config, hal::Journal& journal)
    : journal_(&journal),
      sysid_(config.target_sysid),
      compid_(config.target_compid.value_or(mavlink::component::kAutopilot)),
      guided_mode_(config.guided_mode),
      link_timeout_(config.link_timeout),
      pose_timeout_(config.pose_timeout) {
  state_.last_text.reserve(kMaxText);
}

bool MavlinkTelemetry::is_target(const mavlink::Frame& frame, hal::Instant now) {
  if (frame.compid != compid_) return false;
  if (sysid_) return frame.sysid == *sysid_;
  if (frame.id != mavlink::Heartbeat::kId || frame.sysid == 0) return false;
  const auto heartbeat = mavlink::decode<mavlink::Heartbeat>(frame);
  if (heartbeat.autopilot == mavlink::autopilot_type::kInvalid) return false;
  sysid_ = frame.sysid;
  journal_->note(now, kSource,
                 fmt::format("found: system {} component {} type {} autopilot {}", frame.sysid, frame.compid,
                             heartbeat.type, heartbeat.autopilot));
  return true;
}

bool MavlinkTelemetry::take(const mavlink::Frame& frame, hal::Instant now) {
  if (!is_target(frame, now)) return false;
  switch (frame.id) {
    case mavlink::Heartbeat::kId:
      take_heartbeat(mavlink::decode<mavlink::Heartbeat>(frame), now);
      break;
    case mavlink::LocalPositionNed::kId:
      take_position(mavlink::decode<mavlink::LocalPositionNed>(frame), now);
      break;
    case mavlink::Attitude::kId:
      take_attitude(mavlink::decode<mavlink::Attitude>(frame), now);
      break;
    case mavlink::SysStatus::kId:
      take_battery(mavlink::decode<mavlink::SysStatus>(frame).battery_remaining);
      break;
    case mavlink::BatteryStatus::kId: {
      const auto battery = mavlink::decode<mavlink::BatteryStatus>(frame);
      if (battery.id == 0) take_battery(battery.battery_remaining);
      break;
    }
    case mavlink::ExtendedSysState::kId: {
      const auto landed = mavlink::decode<mavlink::ExtendedSysState>(frame).landed_state;
      state_.in_air = landed == mavlink::landed_state::kInAir || landed == mavlink::landed_state::kTakeoff ||
                      landed == mavlink::landed_state::kLanding;
      break;
    }
    case mavlink::Statustext::kId:
      take_text(mavlink::decode<mavlink::Statustext>(frame), now);
      break;
    default:
      break;
  }
  return true;
}

bool MavlinkTelemetry::update(hal::Instant now) {
  state_.link_up = heard_ && now - state_.last_heartbeat < link_timeout_;
  state_.pose_valid = is_fresh(position_at_, now) && is_fresh(attitude_at_, now);
  if (state_.link_up == link_was_up_) return false;
  link_was_up_ = state_.link_up;
  journal_->note(now, kSource, state_.link_up ? "heartbeats: up" : "heartbeats: lost");
  return state_.link_up;
}

void MavlinkTelemetry::take_heartbeat(const mavlink::Heartbeat& heartbeat, hal::Instant now) {
  const bool armed = (heartbeat.base_mode & mavlink::mode_flag::kSafetyArmed) != 0;
  const bool custom = (heartbeat.base_mode & mavlink::mode_flag::kCustomMode) != 0;
  if (!heard_ || armed != state_.armed || heartbeat.custom_mode != state_.custom_mode) {
    fmt::memory_buffer line;
    fmt::format_to(std::back_inserter(line), "mode {} {}", heartbeat.custom_mode,
                   armed ? "armed" : "disarmed");
    journal_->note(now, kSource, {line.data(), line.size()});
  }
  heard_ = true;
  state_.last_heartbeat = now;
  state_.armed = armed;
  state_.custom_mode = heartbeat.custom_mode;
  state_.guided = custom && heartbeat.custom_mode == guided_mode_;
}

void MavlinkTelemetry::take_position(const mavlink::LocalPositionNed& position, hal::Instant now) {
  const hal::Vec3 place{position.x, position.y, position.z};
  const hal::Vec3 speed{position.vx, position.vy, position.vz};
  if (!hal::is_finite(place) || !hal::is_finite(speed)) return;
  state_.pose_world.position = flip_yz(place);
  state_.velocity_world_m_s = flip_yz(speed);
  position_at_ = now;
}

void MavlinkTelemetry::take_attitude(const mavlink::Attitude& attitude, hal::Instant now) {
  const hal::Pose ned{{}, attitude.yaw, attitude.pitch, attitude.roll};
  if (!hal::is_finite(hal::Vec3{ned.yaw_rad, ned.pitch_rad, ned.roll_rad})) return;
  const hal::Pose world = flip_pose(ned);
  state_.pose_world.yaw_rad = world.yaw_rad;
  state_.pose_world.pitch_rad = world.pitch_rad;
  state_.pose_world.roll_rad = world.roll_rad;
  if (std::isfinite(attitude.yawspeed)) yaw_rate_rad_s_ = -static_cast<double>(attitude.yawspeed);
  attitude_at_ = now;
}

void MavlinkTelemetry::take_battery(int remaining_percent) {
  if (remaining_percent < 0) return;  // the autopilot does not know
  state_.battery_fraction = std::min(remaining_percent, 100) / 100.0;
}

// Long texts come in chunks with one id other than 0; a lost chunk leaves a hole, not a wrong text.
void MavlinkTelemetry::take_text(const mavlink::Statustext& text, hal::Instant now) {
  const auto end = std::ranges::find(text.text, '\0');
  const std::string_view piece(text.text.data(), static_cast<std::size_t>(end - text.text.begin()));
  fmt::memory_buffer line;
  fmt::format_to(std::back_inserter(line), "says [{}] {}", text.severity, piece);
  journal_->note(now, kSource, {line.data(), line.size()});
  if (text.severity > mavlink::severity::kWarning) return;
  const bool continues = text.id != 0 && text.id == chunk_id_ && text.chunk_seq > 0;
  chunk_id_ = text.id;
  if (!continues) state_.last_text.clear();
  state_.last_text.append(piece.substr(0, kMaxText - std::min(kMaxText, state_.last_text.size())));
  last_warning_ = now;
}

}  // namespace forager::flight
