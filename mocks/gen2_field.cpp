#include "mocks/gen2_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hal/units.hpp"

namespace forager::mocks {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kPoseAge_s = 0.005;
// Bounds hold within kBoundSlack_m and are renewed after kBoundMove_m, looked at once per draw or dwell: the
// difference is what the body may move in between, 0.25 m in a patience of some 50 ms.
constexpr double kBoundSlack_m = 0.5;
constexpr double kBoundMove_m = 0.25;
// Power to counted tags is looked at this often at most, and only after the body moved; short against the 2 s
// that S2 flags outlast power at least.
constexpr double kPowerWatch_s = 0.5;
constexpr double kPowerWatchMove_m = 0.05;
constexpr double kPowerWatchTurn_rad = 0.035;

}  // namespace

SimTagField::SimTagField(const World& world, const TrueBody& body, std::vector<AntennaMounting> antennas,
                         const AirParameters& air, std::uint64_t seed)
    : world_(&world),
      body_(&body),
      air_(air),
      link_(world, std::move(antennas), air, seed),
      flags_(world.tags.size(), air, hal::Random::stream(seed, 2).next()),
      schedule_(air, hal::Random::stream(seed, 3).next()),
      random_(hal::Random::stream(seed, 4)),
      heard_in_(world.tags.size(), 0) {
  candidates_.reserve(world.tags.size());
}

double SimTagField::seconds(hal::Instant now) {
  if (!epoch_) epoch_ = now;
  return hal::to_seconds(now - *epoch_);
}

void SimTagField::sample_body(double now_s) {
  previous_pose_ = now_s > now_s_ ? pose_ : previous_pose_;
  previous_s_ = now_s > now_s_ ? now_s_ : previous_s_;
  pose_ = body_->state().pose;
  now_s_ = now_s;
}

void SimTagField::radio_on(const RadioSettings& settings, hal::Instant now) {
  if (on_) radio_off(now);
  sample_body(seconds(now));
  previous_pose_ = pose_;
  settings_ = settings;
  on_ = !settings_.ports.empty();
  if (!on_) return;
  port_views_.reserve(settings_.ports.size());
  max_reach_ = 0.0;
  for (const RadioPort& port : settings_.ports)
    max_reach_ = std::max(max_reach_, link_.view(pose_, port).reach);
  bounds_at_.reset();
  power_watched_at_.reset();
  schedule_.start(settings_, now_s_);
  begin_dwell();
}

void SimTagField::radio_off(hal::Instant now) {
  if (!on_) return;
  on_ = false;
  const double now_s = seconds(now);
  for (std::uint32_t tag = 0; tag < world_->tags.size(); ++tag) flags_.set_power(tag, false, now_s);
}

void SimTagField::advance(hal::Instant now, std::vector<AirRead>& out) {
  sample_body(seconds(now));
  if (!on_) return;
  while (true) {
    const double end_s = schedule_.dwell().end_s;
    if (std::min(next_draw_s_, end_s) > now_s_) return;
    if (next_draw_s_ <= end_s) {
      draw(out);
    } else {
      schedule_.advance();
      begin_dwell();
    }
  }
}

hal::Pose SimTagField::pose_at(double t_s) const {
  if (t_s >= now_s_ || now_s_ <= previous_s_) return pose_;
  const double share = std::max(t_s - previous_s_, 0.0) / (now_s_ - previous_s_);
  const auto between = [share](double a, double b) { return a + share * (b - a); };
  return {previous_pose_.position + share * (pose_.position - previous_pose_.position),
          previous_pose_.yaw_rad + share * hal::angle_difference(pose_.yaw_rad, previous_pose_.yaw_rad),
          between(previous_pose_.pitch_rad, pose_.pitch_rad),
          between(previous_pose_.roll_rad, pose_.roll_rad)};
}

void SimTagField::begin_dwell() {
  ++statistics_.dwells;
  const double start_s = schedule_.dwell().start_s;
  refresh_bounds_if_moved(pose_at(start_s).position);
  if (flags_.needs_power_watch()) watch_power(start_s);
  schedule_draw(start_s + air_.settle_s);
}

void SimTagField::schedule_draw(double from_s) {
  const double total = candidates_.empty() ? 0.0 : candidates_.back().sum_per_s;
  next_draw_s_ = total > 0.0 ? from_s + random_.exponential() / total : kNever;
}

void SimTagField::draw(std::vector<AirRead>& out) {
  const double t_s = next_draw_s_;
  const Dwell& dwell = schedule_.dwell();
  ++statistics_.draws;
  refresh_view(t_s);
  const double pick = random_.uniform() * candidates_.back().sum_per_s;
  const auto above = [](double value, const Candidate& c) { return value < c.sum_per_s; };
  const Candidate chosen =
      *std::min(std::upper_bound(candidates_.begin(), candidates_.end(), pick, above), candidates_.end() - 1);
  const double keep_below = random_.uniform() * chosen.bound_per_s;
  double free_s = t_s;
  if (flags_.answers(chosen.tag, settings_.session, settings_.target, t_s, dwell.id)) {
    const TagLink link = link_.link(view_, chosen.tag);
    const double rate = link_.hazard(link);
    if (rate > chosen.bound_per_s) ++statistics_.bound_exceeded;
    if (keep_below < rate) {
      const double round_end_s =
          air_.round_s > 0.0
              ? dwell.start_s + (std::floor((t_s - dwell.start_s) / air_.round_s) + 1.0) * air_.round_s
              : t_s;
      flags_.singulate(chosen.tag, settings_.session, settings_.target, t_s, dwell.id, round_end_s);
      report(link, chosen.tag, t_s, out);
      free_s += air_.singulation_s;
    }
  }
  refresh_bounds_if_moved(pose_at(t_s).position);
  schedule_draw(free_s);
}

void SimTagField::report(const TagLink& link, std::uint32_t tag, double t_s, std::vector<AirRead>& out) {
  ++statistics_.singulations;
  const Dwell& dwell = schedule_.dwell();
  if (heard_in_[tag] != dwell.id) schedule_.prolong(t_s);
  heard_in_[tag] = dwell.id;
  const RadioPort& port = settings_.ports[dwell.port_index];
  const double rssi = link_.rssi_dbm(view_, link, tag) + air_.rssi_noise_db * random_.normal();
  if (rssi < port.sensitivity_dbm) {
    ++statistics_.too_weak;
    return;
  }
  out.push_back({tag, port.port, static_cast<int>(std::lround(rssi)),
                 AirLink::phase_deg(link.range_m, dwell.frequency_khz), dwell.frequency_khz,
                 *epoch_ + hal::from_seconds(t_s)});
}

void SimTagField::refresh_view(double t_s) {
  const Dwell& dwell = schedule_.dwell();
  if (view_dwell_ == dwell.id && t_s - view_s_ < kPoseAge_s) return;
  view_ = link_.view(pose_at(t_s), settings_.ports[dwell.port_index]);
  view_s_ = t_s;
  view_dwell_ = dwell.id;
}

void SimTagField::refresh_bounds_if_moved(hal::Vec3 position) {
  if (bounds_at_ && norm(position - *bounds_at_) < kBoundMove_m) return;
  bounds_at_ = position;
  candidates_.clear();
  double sum = 0.0;
  for (std::uint32_t tag = 0; tag < world_->tags.size(); ++tag) {
    const double bound = link_.hazard_bound(position, kBoundSlack_m, max_reach_, tag);
    if (bound <= 0.0) continue;
    sum += bound;
    candidates_.push_back({tag, bound, sum});
  }
}

// Which of the counted tags get power from any port. While the body rests nothing changes.
void SimTagField::watch_power(double t_s) {
  if (power_watched_at_ && t_s - power_watched_s_ < kPowerWatch_s) return;
  const hal::Pose pose = pose_at(t_s);
  if (power_watched_at_ && norm(pose.position - power_watched_at_->position) < kPowerWatchMove_m &&
      std::abs(hal::angle_difference(pose.yaw_rad, power_watched_at_->yaw_rad)) < kPowerWatchTurn_rad)
    return;
  power_watched_at_ = pose;
  power_watched_s_ = t_s;
  port_views_.clear();
  for (const RadioPort& port : settings_.ports) port_views_.push_back(link_.view(pose, port));
  for (std::uint32_t tag = 0; tag < world_->tags.size(); ++tag) {
    if (!flags_.holds(tag)) continue;
    const auto reaches = [&](const AntennaView& view) { return std::isfinite(link_.link(view, tag).u); };
    flags_.set_power(tag, std::any_of(port_views_.begin(), port_views_.end(), reaches), t_s);
  }
}

}  // namespace forager::mocks
