#include "mocks/gen2_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hal/units.hpp"

namespace forager::mocks {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kPoseAge_s = 0.005;
// While the radio listens the body is looked at this often at least.
constexpr double kLook_s = 0.02;
// Bounds hold within kBoundSlack_m and are renewed after kBoundMove_m: the difference is what the body may
// move between two looks.
constexpr double kBoundSlack_m = 0.5;
constexpr double kBoundMove_m = 0.25;
// What an antenna may hear holds within kTurnSlack_rad and is renewed after kTurnMove_rad; the difference
// between two looks is a turn of 140 degrees a second.
constexpr double kTurnSlack_rad = 0.1;
constexpr double kTurnMove_rad = 0.05;
// Silent tags are left out for this long; shorter than S2 and S3 flags outlast power.
constexpr double kSilence_s = 1.0;
// A look at a tag costs about an eighth of a draw in vain.
constexpr std::size_t kLooksPerDraw = 8;
constexpr std::size_t kFewDraws = 64;

double distance2(hal::Vec3 a, hal::Vec3 b) {
  const hal::Vec3 d = a - b;
  return d.x * d.x + d.y * d.y + d.z * d.z;
}

// Upper bound of the angle between two attitudes.
double turn_between(const hal::Pose& a, const hal::Pose& b) {
  double yaw = std::abs(a.yaw_rad - b.yaw_rad);
  if (yaw > hal::kPi) yaw = std::abs(hal::angle_difference(a.yaw_rad, b.yaw_rad));
  return yaw + std::abs(a.pitch_rad - b.pitch_rad) + std::abs(a.roll_rad - b.roll_rad);
}

}  // namespace

SimTagField::SimTagField(const World& world, const TrueBody& body,
                         const std::vector<AntennaMounting>& antennas, const AirParameters& air,
                         std::uint64_t seed)
    : world_(&world),
      body_(&body),
      air_(air),
      link_(world, antennas, air, seed),
      flags_(world.tags.size(), air, hal::Random::stream(seed, 2).next()),
      schedule_(air, hal::Random::stream(seed, 3).next()),
      random_(hal::Random::stream(seed, 4)),
      nearby_(world, link_, air),
      powered_(world.tags.size()),
      heard_in_(world.tags.size(), 0) {}

double SimTagField::seconds(hal::Instant now) {
  if (!epoch_) epoch_ = now;
  return hal::to_seconds(now - *epoch_);
}

void SimTagField::radio_on(const RadioSettings& settings, hal::Instant now) {
  if (on_) radio_off(now);
  const hal::Pose pose = body_->state().pose;
  track_.start(seconds(now), pose);
  settings_ = settings;
  on_ = !settings_.ports.empty();
  if (!on_) return;
  max_reach_ = 0.0;
  for (const RadioPort& port : settings_.ports)
    max_reach_ = std::max(max_reach_, link_.view(pose, port).reach);
  ears_.assign(settings_.ports.size(), Ear{});
  nearby_at_.reset();
  powered_.forget();
  schedule_.start(settings_, track_.now_s());
  begin_dwell();
}

void SimTagField::radio_off(hal::Instant now) {
  if (!on_) return;
  on_ = false;
  powered_.all_off(seconds(now), flags_);
}

void SimTagField::advance(hal::Instant now, std::vector<AirRead>& out) {
  track_.look(seconds(now), body_->state().pose);
  if (!on_) return;
  while (true) {
    const double end_s = schedule_.dwell().end_s;
    const double next_s = std::min({next_draw_s_, next_look_s_, end_s});
    if (next_s > track_.now_s()) return;
    if (next_s == next_draw_s_) {
      draw(out);
    } else if (next_s == end_s) {
      schedule_.advance();
      begin_dwell();
    } else {
      next_look_s_ = next_s + kLook_s;
      if (look_around(next_s)) {
        free_s_ = std::max(free_s_, next_s);
        schedule_draw();
      }
    }
  }
}

void SimTagField::begin_dwell() {
  ++statistics_.dwells;
  const double start_s = schedule_.dwell().start_s;
  next_look_s_ = start_s + kLook_s;
  free_s_ = start_s + air_.settle_s;
  look_around(start_s);
  if (flags_.needs_power_watch())
    powered_.update(start_s, track_.at(start_s), max_reach_, link_, nearby_, settings_.ports, flags_);
  if (ear().audible.total_per_s <= 0.0) ++statistics_.blind_dwells;
  schedule_draw();
}

void SimTagField::schedule_draw() {
  const double total = ear().audible.total_per_s;
  next_draw_s_ = total > 0.0 ? free_s_ + random_.exponential() / total : kNever;
}

void SimTagField::draw(std::vector<AirRead>& out) {
  const double t_s = next_draw_s_;
  const Dwell& dwell = schedule_.dwell();
  ++statistics_.draws;
  const NearbyTags::Candidate chosen = nearby_.pick(ear().audible, random_.uniform());
  const double keep_below = random_.uniform() * chosen.bound_per_s;
  free_s_ = t_s;
  if (flags_.answers(chosen.tag, settings_.session, settings_.target, t_s, dwell.id)) {
    if (t_s - ear().at_s >= kPoseAge_s) renew_view(t_s, track_.at(t_s));
    const TagLink link = link_.link_above(ear().view, chosen.tag, keep_below);
    const double rate = link_.hazard(link);
    if (rate > chosen.bound_per_s) ++statistics_.bound_exceeded;
    if (keep_below < rate) {
      const double round_end_s =
          air_.round_s > 0.0
              ? dwell.start_s + (std::floor((t_s - dwell.start_s) / air_.round_s) + 1.0) * air_.round_s
              : t_s;
      flags_.singulate(chosen.tag, settings_.session, settings_.target, t_s, dwell.id, round_end_s);
      if (settings_.session >= 2) powered_.singulated(chosen.tag);
      report(link, chosen.tag, t_s, out);
      free_s_ += air_.singulation_s;
    }
  } else if (settings_.session > 0) {
    ++silent_draws_;
  }
  schedule_draw();
}

void SimTagField::report(const TagLink& link, std::uint32_t tag, double t_s, std::vector<AirRead>& out) {
  ++statistics_.singulations;
  const Dwell& dwell = schedule_.dwell();
  if (heard_in_[tag] != dwell.id) schedule_.prolong(t_s);
  heard_in_[tag] = dwell.id;
  const RadioPort& port = settings_.ports[dwell.port_index];
  const double rssi = link_.rssi_dbm(ear().view, link, tag) + air_.rssi_noise_db * random_.normal();
  if (rssi < port.sensitivity_dbm) {
    ++statistics_.too_weak;
    return;
  }
  out.push_back({tag, port.port, static_cast<int>(std::lround(rssi)),
                 AirLink::phase_deg(link.range_m, dwell.frequency_khz), dwell.frequency_khz,
                 *epoch_ + hal::from_seconds(t_s)});
}

bool SimTagField::look_around(double t_s) {
  const hal::Pose pose = track_.at(t_s);
  const bool moved = !nearby_at_ || distance2(pose.position, *nearby_at_) >= kBoundMove_m * kBoundMove_m;
  const bool worth = air_.skip_silent && silent_draws_ > kFewDraws + nearby_.examined() / kLooksPerDraw;
  if (moved || worth || t_s >= silent_until_s_) renew_nearby(t_s, pose.position);
  Ear& ear = this->ear();
  if (t_s - ear.at_s >= kPoseAge_s || !ear.known) renew_view(t_s, pose);
  if (ear.audible_generation == nearby_.generation() &&
      (!air_.skip_behind || turn_between(pose, ear.audible_body) < kTurnMove_rad))
    return false;
  ear.audible = air_.skip_behind ? nearby_.before(ear.view, kTurnSlack_rad) : nearby_.everything();
  if (air_.skip_blind_antennas && !ear.view.fitted) ear.audible = {};
  if (!air_.skip_blind_antennas && ear.audible.total_per_s <= 0.0) ear.audible = nearby_.everything();
  ear.audible_body = pose;
  ear.audible_generation = nearby_.generation();
  return true;
}

void SimTagField::renew_nearby(double t_s, hal::Vec3 position) {
  nearby_at_ = position;
  const double silence_s = std::min(kSilence_s, air_.s2_persistence_min_s);
  const bool silences =
      air_.skip_silent && settings_.session > 0 && settings_.target != '*' && silence_s > kLook_s;
  const NearbyTags::Silence silence{.flags = &flags_,
                                    .session = settings_.session,
                                    .target = settings_.target,
                                    .dwell = schedule_.dwell().id,
                                    .now_s = t_s,
                                    .until_s = t_s + silence_s};
  nearby_.renew({position, kBoundSlack_m, max_reach_}, silences ? &silence : nullptr);
  silent_draws_ = 0;
  silent_until_s_ = nearby_.silent() > 0 ? t_s + silence_s : kNever;
  ++statistics_.renewals;
  statistics_.examined += nearby_.examined();
}

void SimTagField::renew_view(double t_s, const hal::Pose& pose) {
  Ear& ear = this->ear();
  ear.at_s = t_s;
  if (ear.known && distance2(pose.position, ear.body.position) <= air_.unchanged_m * air_.unchanged_m &&
      turn_between(pose, ear.body) <= air_.unchanged_rad)
    return;
  ear.known = true;
  ear.view = link_.view(pose, settings_.ports[schedule_.dwell().port_index]);
  ear.body = pose;
  ++statistics_.views;
}

}  // namespace forager::mocks
