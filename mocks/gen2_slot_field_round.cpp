// What happens within a round of SlotTagField.
#include <algorithm>
#include <cmath>

#include "mocks/gen2_slot_field.hpp"

namespace forager::mocks {
namespace {

// A reply is understood with this chance at least, once the tag takes part: bounds the replies in vain.
constexpr double kLeastUnderstood = 0.25;
// Share of an RN16 in the bits that must be right: 17 of 146 without their preambles.
constexpr double kRn16Share = 17.0 / 146.0;
constexpr double kMicro = 1e-6;

}  // namespace

SlotTagField::Chances SlotTagField::chances(const NearbyTags::Candidate& candidate) {
  const TagLink link = link_.link(view_, candidate.tag);
  const double rate = link_.hazard(link);
  if (rate > candidate.bound_per_s) ++statistics_.bound_exceeded;
  if (!(rate > 0.0)) return {0.0, 1.0};
  return {rate,
          std::max(decode_probability(slots_, link_.rssi_dbm(view_, link, candidate.tag)), kLeastUnderstood)};
}

void SlotTagField::join(std::uint32_t tag, bool heard) {
  const std::uint64_t mark = 2 * statistics_.rounds;
  if (drawn_in_[tag] >= mark) {
    if (heard) drawn_in_[tag] = mark + 1;
    return;
  }
  drawn_in_[tag] = mark + (heard ? 1U : 0U);
  ++statistics_.participants;
  const bool is_b = flags_.is_b(tag, settings_.session, next_s_, carrier_);
  if (settings_.target == '*' && is_b) {
    others_.push_back(tag);
  } else {
    round_.join(tag);
  }
}

void SlotTagField::draw_participants(double listened_s) {
  round_.clear();
  others_.clear();
  const AntennaView& view = view_at(next_s_);
  const Audible audible = air_.skip_behind ? nearby_.before(view, 0.0) : nearby_.everything();
  if (!view.fitted || audible.total_per_s <= 0.0) return;
  const double draws = audible.total_per_s / kLeastUnderstood * listened_s;
  if (draws < static_cast<double>(nearby_.all().size())) {
    draw_thinned(audible, listened_s);
  } else {
    draw_each(listened_s);
  }
}

// A Poisson process under the bounds, each of its points kept with true rate / bound: a tag is met at least
// once with chance 1 - exp(-rate L).
void SlotTagField::draw_thinned(const Audible& audible, double listened_s) {
  const double rate_per_s = audible.total_per_s / kLeastUnderstood;
  double at_s = 0.0;
  while ((at_s += random_.exponential() / rate_per_s) < listened_s) {
    ++statistics_.draws;
    const NearbyTags::Candidate& candidate = nearby_.pick(audible, random_.uniform());
    const double keep_below = random_.uniform() * candidate.bound_per_s / kLeastUnderstood;
    if (settings_.target != '*' &&
        flags_.is_b(candidate.tag, settings_.session, next_s_, carrier_) != (settings_.target == 'B'))
      continue;
    const Chances c = chances(candidate);
    if (keep_below < c.rate_per_s / c.understood) join(candidate.tag, keep_below < c.rate_per_s);
  }
}

// The same law tag by tag, cheaper when nearly every tag takes part.
void SlotTagField::draw_each(double listened_s) {
  for (const NearbyTags::Candidate& candidate : nearby_.all()) {
    ++statistics_.draws;
    if (settings_.target != '*' &&
        flags_.is_b(candidate.tag, settings_.session, next_s_, carrier_) != (settings_.target == 'B'))
      continue;
    const Chances c = chances(candidate);
    if (!(c.rate_per_s > 0.0)) continue;
    const double heard = answer_probability(c.rate_per_s, listened_s);
    const double in_vain = answer_probability(c.rate_per_s * (1.0 - c.understood) / c.understood, listened_s);
    if (random_.chance(heard)) {
      join(candidate.tag, true);
    } else if (random_.chance(in_vain)) {
      join(candidate.tag, false);
    }
  }
}

// Takes the time of a slot that lasts so long behind QueryRep; false if the carrier goes off within it.
bool SlotTagField::lasts(double slot_us) {
  const double slot_s = kMicro * (slot_us + command_us_ - times_.query_rep_us);
  if (cut_off(kMicro * command_us_, slot_s)) return false;
  next_s_ += slot_s;
  return true;
}

void SlotTagField::run_slot() {
  command_us_ = times_.query_rep_us;
  if (round_.command() == SlotCommand::query) command_us_ = times_.query_us;
  if (round_.command() == SlotCommand::query_adjust) command_us_ = times_.query_adjust_us;
  const auto replies = round_.open_slot(random_);
  if (replies.empty()) return hear_nothing();
  const bool captured = replies.size() > 1 && random_.chance(slots_.capture_probability);
  if (replies.size() > 1 && !captured) {
    if (!lasts(times_.collided_us)) return;
    ++statistics_.collided;
    return round_.heard_collision();
  }
  const std::size_t chosen = captured ? strongest(replies) : 0;
  const std::uint32_t tag = replies[chosen];
  const TagLink link = link_.link(view_at(next_s_), tag);
  if (!std::isfinite(link.u)) {  // it went out of power within the round
    round_.leave(chosen);
    return hear_nothing();
  }
  if (drawn_in_[tag] % 2 == 0) return lose(chosen, link);
  if (!lasts(times_.success_us)) return;
  ++statistics_.single;
  statistics_.captured += captured ? 1U : 0U;
  heard_ = Heard{tag, link, !asks_b_, false};
  round_.heard_one(chosen);
}

void SlotTagField::hear_nothing() {
  const double start_s = next_s_;
  if (!lasts(times_.empty_us)) return;
  ++statistics_.empty;
  listened() += next_s_ - start_s;
  round_.heard_nothing();
}

// A reply that is not understood: an RN16 has no CRC, so the reader acknowledges another number than the
// tag's and hears nothing; an EPC with a bad CRC is answered with NAK.
void SlotTagField::lose(std::size_t chosen, const TagLink& link) {
  const std::uint32_t tag = round_.answering()[chosen];
  const double s = std::max(decode_probability(slots_, link_.rssi_dbm(view_, link, tag)), kLeastUnderstood);
  const bool rn16_lost = random_.uniform() * (1.0 - s) < 1.0 - std::pow(s, kRn16Share);
  const double nak_us = slots_.nak_bad_replies ? times_.nak_us + silence_us_ : 0.0;
  if (!lasts(rn16_lost ? times_.ack_no_epc_us : times_.success_us + nak_us)) return;
  ++statistics_.lost;
  // Without the NAK it takes the next command for a good ending.
  if (!rn16_lost && !slots_.nak_bad_replies) heard_ = Heard{tag, link, !asks_b_, true};
  round_.heard_one(chosen);
}

std::size_t SlotTagField::strongest(std::span<const std::uint32_t> replies) {
  const AntennaView& view = view_at(next_s_);
  std::size_t best = 0;
  double best_dbm = -1e9;
  for (std::size_t i = 0; i < replies.size(); ++i) {
    const TagLink link = link_.link(view, replies[i]);
    const double dbm = std::isfinite(link.u) ? link_.rssi_dbm(view, link, replies[i]) : -1e9;
    if (dbm <= best_dbm) continue;
    best = i;
    best_dbm = dbm;
  }
  return best;
}

}  // namespace forager::mocks
