#include "mocks/sim_autopilot.hpp"

#include <algorithm>

namespace forager::mocks {
namespace {
constexpr hal::Duration kHeartbeatInterval = std::chrono::seconds(1);
constexpr hal::Duration kTimesyncInterval = std::chrono::seconds(10);  // GCS_MAVLINK's own requests
}  // namespace

SimAutopilot::SimAutopilot(hal::ByteStream& stream, const SimAutopilotConfig& config)
    : config_(config),
      link_(stream, config, faults_),
      vehicle_(config.vehicle, config.start),
      estimator_(config.estimator, config.seed),
      mode_(config.mode),
      landed_(vehicle_.state().on_ground),
      origin_known_(config.origin_known) {
  constexpr std::array kOffered{&peer::kHeartbeat,         &peer::kTimesync,         &peer::kSysStatus,
                                &peer::kSystemTime,        &peer::kAttitude,         &peer::kLocalPositionNed,
                                &peer::kGlobalPositionInt, &peer::kGpsGlobalOrigin,  &peer::kSimState,
                                &peer::kBatteryStatus,     &peer::kAutopilotVersion, &peer::kEkfStatusReport,
                                &peer::kExtendedSysState};
  static_assert(kOffered.size() == std::tuple_size_v<decltype(streams_)>);
  for (std::size_t i = 0; i < kOffered.size(); ++i) streams_[i].kind = kOffered[i];
  streams_[0].interval = kHeartbeatInterval;
  streams_[1].interval = kTimesyncInterval;
}

void SimAutopilot::attach(const World* world, hal::Journal* journal, bool wire) {
  journal_ = journal;
  vehicle_.attach(world, journal);
  link_.attach(wire ? journal : nullptr);
}

void SimAutopilot::start(hal::Instant now) {
  started_ = true;
  epoch_ = clock_ = idle_since_ = now;
  for (Stream& stream : streams_) stream.next = now;
  target_ = hold_here(estimator_.estimate(), now);
}

void SimAutopilot::update(hal::Instant now) {
  if (!started_) start(now);
  now_ = now;
  link_.service(now);
  while (clock_ + config_.step <= now) step();
  while (const MavlinkPeerFrame* frame = link_.receive(now)) hear(*frame);
}

void SimAutopilot::step() {
  clock_ += config_.step;
  apply_faults();
  if (wheels_ != nullptr) {
    roll();
  } else {
    vehicle_.command(flight_command());
    vehicle_.update(config_.step, clock_);
  }
  estimator_.propagate(state(), hal::to_seconds(config_.step), faults_.yaw_drift_rad_s, clock_);
  watch_ground();
  watch_estimator();
  send_streams();
}

void SimAutopilot::apply_faults() {
  const hal::Duration age = clock_ - epoch_;
  link_.silent(faults_.silence && age >= faults_.silence->from && age < faults_.silence->to);
  if (faults_.battery && age >= faults_.battery->at) {
    vehicle_.set_battery_fraction(faults_.battery->fraction);
    faults_.battery.reset();
  }
  if (faults_.pilot && age >= faults_.pilot->at) {
    const peer::CopterMode mode = faults_.pilot->mode;
    faults_.pilot.reset();
    set_mode(mode, "pilot");
  }
}

void SimAutopilot::send_streams() {
  for (Stream& stream : streams_) {
    if (stream.interval <= hal::Duration::zero() || clock_ < stream.next) continue;
    // Faster than the steps is once a step; what was missed is not made up for.
    stream.next = std::max(stream.next + stream.interval, clock_);
    const bool muted = stream.kind == &peer::kHeartbeat && faults_.heartbeat_stop &&
                       clock_ - epoch_ >= *faults_.heartbeat_stop;
    if (!muted) say(*stream.kind);
  }
}

int SimAutopilot::servo_us(int output) const {
  return output >= 1 && output <= 16 ? servo_us_[static_cast<std::size_t>(output - 1)] : 0;
}

}  // namespace forager::mocks
