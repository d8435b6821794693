#include "mocks/gen2_slot_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace forager::mocks {
namespace {

constexpr double kPoseAge_s = 0.005;
// Bounds hold within kBoundSlack_m and are renewed after kBoundMove_m, looked at once per round: the
// difference is what the body may move in between.
constexpr double kBoundSlack_m = 0.5;
constexpr double kBoundMove_m = 0.25;
constexpr double kSilence_s = 1.0;
constexpr double kNever = std::numeric_limits<double>::infinity();
// The first round of all is drawn for this share of a round, so that on average a lone tag is read neither
// early nor late: rounds come half a round late, and a slot is in the middle of its round.
constexpr double kFirstShare = 0.5;
// ETSI EN 302 208, lower band: the four high-power channels.
constexpr std::uint32_t kFirstChannel_khz = 865700;
constexpr std::uint32_t kChannelSpacing_khz = 600;

}  // namespace

SlotTagField::SlotTagField(const World& world, const TrueBody& body,
                           const std::vector<AntennaMounting>& antennas, const AirParameters& air,
                           const SlotParameters& slots, std::uint64_t seed)
    : world_(&world),
      body_(&body),
      air_(air),
      slots_(slots),
      link_(world, antennas, air, seed),
      flags_(world.tags.size(), air, hal::Random::stream(seed, 2).next()),
      nearby_(world, link_, air),
      powered_(world.tags.size()),
      schedule_(air, hal::Random::stream(seed, 3).next()),
      round_(world.tags.size()),
      random_(hal::Random::stream(seed, 4)),
      drawn_in_(world.tags.size(), 0),
      heard_in_(world.tags.size(), 0) {
  others_.reserve(world.tags.size());
}

const std::string& SlotTagField::epc_hex(std::uint32_t tag) const {
  epc_text_.clear();
  world_->tags.append_epc_hex(tag, epc_text_);
  return epc_text_;
}

double SlotTagField::seconds(hal::Instant now) {
  if (!epoch_) epoch_ = now;
  return hal::to_seconds(now - *epoch_);
}

void SlotTagField::radio_on(const RadioSettings& settings, hal::Instant now) {
  if (on_) radio_off(now);
  const double now_s = seconds(now);
  track_.start(now_s, body_->state().pose);
  settings_ = settings;
  on_ = !settings_.ports.empty();
  if (!on_) return;
  max_reach_ = 0.0;
  for (const RadioPort& port : settings_.ports)
    max_reach_ = std::max(max_reach_, link_.view(track_.at(now_s), port).reach);
  times_ = slot_times(slots_.link, static_cast<std::uint8_t>(settings_.session));
  silence_us_ = times_.empty_us - times_.query_rep_us;
  idle_round_s_ = idle_round_s(slots_, settings_.q);
  listened_s_.assign(settings_.ports.size(), kFirstShare * idle_round_s_);
  nearby_at_.reset();
  powered_.forget();
  schedule_.start(settings_, now_s);
  first_round_ = true;
  next_s_ = now_s;
  phase_ = Phase::carrier;
}

void SlotTagField::radio_off(hal::Instant now) {
  if (!on_) return;
  on_ = false;
  heard_.reset();
  powered_.all_off(seconds(now), flags_);
}

void SlotTagField::advance(hal::Instant now, std::vector<AirRead>& out) {
  track_.look(seconds(now), body_->state().pose);
  if (!on_) return;
  while (next_s_ <= track_.now_s()) step(out);
}

void SlotTagField::step(std::vector<AirRead>& out) {
  switch (phase_) {
    case Phase::carrier:
      raise_carrier();
      break;
    case Phase::round:
      begin_round();
      break;
    case Phase::slot:
      close_slot(out);
      break;
  }
}

void SlotTagField::raise_carrier() {
  const Dwell& dwell = schedule_.dwell();
  ++carrier_;
  if (view_dwell_ != dwell.id) {
    ++statistics_.dwells;
    frequency_khz_ = dwell.frequency_khz;
  }
  look_around(next_s_);
  if (flags_.needs_power_watch())
    powered_.update(next_s_, track_.at(next_s_), max_reach_, link_, nearby_, settings_.ports, flags_);
  next_hop_s_ = slots_.hop_interval_s > 0.0 ? next_s_ + slots_.hop_interval_s : kNever;
  next_s_ += air_.settle_s;
  phase_ = Phase::round;
}

// What was acknowledged and heard no further command is not counted.
void SlotTagField::drop_carrier() {
  heard_.reset();
  phase_ = Phase::carrier;
}

void SlotTagField::leave_port(double at_s) {
  drop_carrier();
  first_round_ = true;
  schedule_.leave(at_s);
  schedule_.advance();
  next_s_ = std::max(schedule_.dwell().start_s, at_s);
}

void SlotTagField::begin_round() {
  const double t_s = next_s_;
  const double latest_s = schedule_.latest_end_s();
  if (t_s + slots_.round_overhead_s >= latest_s) return leave_port(latest_s);  // no slot would fit
  // Rounds are whole: a visit ends with the one that is nearest to what the schedule wants, but the latest
  // end, a fixed dwell's included, is kept to the instant.
  const double wanted_s = schedule_.dwell().end_s;
  const double early_s = wanted_s < latest_s ? 0.5 * idle_round_s_ : 0.0;
  if (!first_round_ && t_s + early_s >= wanted_s) return leave_port(t_s);
  first_round_ = false;
  if (t_s >= next_hop_s_) {
    ++statistics_.hops;
    const std::uint32_t channel = (frequency_khz_ - kFirstChannel_khz) / kChannelSpacing_khz;
    const auto other = static_cast<std::uint32_t>((channel + 1 + random_.below(3)) % 4);
    frequency_khz_ = kFirstChannel_khz + kChannelSpacing_khz * other;
    return drop_carrier();
  }
  ++statistics_.rounds;
  look_around(t_s);
  offered_s_ = std::exchange(listened(), 0.0);
  draw_participants(offered_s_);
  begin_frames(settings_.target == 'B');
  listened() += slots_.round_overhead_s;
  next_s_ += slots_.round_overhead_s;
  phase_ = Phase::slot;
}

void SlotTagField::look_around(double t_s) {
  const hal::Vec3 position = track_.at(t_s).position;
  if (nearby_at_ && norm(position - *nearby_at_) < kBoundMove_m && t_s < silent_until_s_) return;
  nearby_at_ = position;
  const double silence_s = std::min(kSilence_s, air_.s2_persistence_min_s);
  const bool silences = air_.skip_silent && settings_.session > 0 && settings_.target != '*';
  const NearbyTags::Silence silence{.flags = &flags_,
                                    .session = settings_.session,
                                    .target = settings_.target,
                                    .dwell = carrier_,
                                    .now_s = t_s,
                                    .until_s = t_s + silence_s};
  nearby_.renew({position, kBoundSlack_m, max_reach_}, silences ? &silence : nullptr);
  silent_until_s_ = nearby_.silent() > 0 ? t_s + silence_s : kNever;
}

void SlotTagField::begin_frames(bool b) {
  asks_b_ = b;
  round_.start(settings_.q >= 0 ? QAlgorithm(settings_.q, 0.0) : QAlgorithm(slots_.first_q, slots_.q_step));
}

// The slot before ends here, the next one begins.
void SlotTagField::close_slot(std::vector<AirRead>& out) {
  if (heard_ && !heard_->reported) report(out);
  if (!round_.over()) return run_slot();
  if (settings_.target == '*' && !asks_b_) {
    // AB: at once the other half.
    round_.clear();
    for (const std::uint32_t tag : others_) round_.join(tag);
    begin_frames(true);
    return run_slot();
  }
  phase_ = Phase::round;
}

// True if the carrier goes off, regulation or duty cycle, before the slot has ended.
bool SlotTagField::cut_off(double command_s, double slot_s) {
  const double end_s = schedule_.latest_end_s();
  if (next_s_ + command_s <= end_s) count_heard();
  if (next_s_ + slot_s <= end_s) return false;
  ++statistics_.cut;
  // Whoever was not heard yet has had no chance.
  if (round_.tags_left() > 0) listened() = std::max(listened(), offered_s_);
  leave_port(end_s);
  return true;
}

void SlotTagField::count_heard() {
  if (!heard_) return;
  if (settings_.session >= 2) powered_.singulated(heard_->tag);
  flags_.set(heard_->tag, settings_.session, heard_->to_b, next_s_, carrier_);
  heard_.reset();
}

void SlotTagField::report(std::vector<AirRead>& out) {
  const Dwell& dwell = schedule_.dwell();
  const std::uint32_t tag = heard_->tag;
  heard_->reported = true;
  if (heard_in_[tag] != dwell.id) schedule_.prolong(next_s_);
  heard_in_[tag] = dwell.id;
  const RadioPort& port = settings_.ports[dwell.port_index];
  const double rssi = link_.rssi_dbm(view_, heard_->link, tag) + air_.rssi_noise_db * random_.normal();
  if (rssi < port.sensitivity_dbm) {
    ++statistics_.too_weak;
    return;
  }
  out.push_back({tag, port.port, static_cast<int>(std::lround(rssi)),
                 AirLink::phase_deg(heard_->link.range_m, frequency_khz_), frequency_khz_,
                 *epoch_ + hal::from_seconds(next_s_)});
}

const AntennaView& SlotTagField::view_at(double t_s) {
  const Dwell& dwell = schedule_.dwell();
  if (view_dwell_ != dwell.id || t_s - view_s_ >= kPoseAge_s) {
    view_ = link_.view(track_.at(t_s), settings_.ports[dwell.port_index]);
    view_s_ = t_s;
    view_dwell_ = dwell.id;
  }
  return view_;
}

}  // namespace forager::mocks
