#include "mocks/gen2_slot_tag.hpp"

#include <algorithm>

namespace forager::mocks {
namespace {

// What Select does to a flag, for tags that match and for the others (Gen2 v1.2.0 table 6.20). Set means SL
// asserted or inventoried A.
enum class Change : std::uint8_t { none, set, clear, negate };
struct Changes {
  Change matching;
  Change others;
};
constexpr Changes kActions[8] = {{Change::set, Change::clear},  {Change::set, Change::none},
                                 {Change::none, Change::clear}, {Change::negate, Change::none},
                                 {Change::clear, Change::set},  {Change::clear, Change::none},
                                 {Change::none, Change::set},   {Change::none, Change::negate}};

bool changed(bool set, Change change) {
  switch (change) {
    case Change::set:
      return true;
    case Change::clear:
      return false;
    case Change::negate:
      return !set;
    case Change::none:
      break;
  }
  return set;
}

}  // namespace

void SlotTag::power_on(double now_s, std::uint64_t carrier) {
  powered_ = true;
  carrier_ = carrier;
  state_ = TagState::ready;
  flags_->set_power(index_, true, now_s);
}

void SlotTag::power_off(double now_s) {
  powered_ = false;
  state_ = TagState::ready;
  flags_->set_power(index_, false, now_s);
}

bool SlotTag::is_b(int session, double now_s) const {
  if (session == 1 && state_ != TagState::ready) return s1_in_round_;
  return flags_->is_b(index_, session, now_s, carrier_);
}

TagReply SlotTag::draw_slot() {
  slot_ = static_cast<std::uint16_t>(random_.below(1ULL << q_));
  if (slot_ != 0) {
    state_ = TagState::arbitrate;
    return TagReply::nothing;
  }
  state_ = TagState::reply;
  rn16_ = static_cast<std::uint16_t>(random_.below(0x10000));
  return TagReply::rn16;
}

void SlotTag::count_if_acknowledged(double now_s) {
  if (state_ != TagState::acknowledged) return;
  const bool b = !is_b(session_, now_s);
  flags_->set(index_, session_, b, now_s, carrier_);
  state_ = TagState::ready;
}

TagReply SlotTag::query(const Gen2Query& query, double now_s) {
  if (!powered_) return TagReply::nothing;
  if (query.session == session_) count_if_acknowledged(now_s);
  state_ = TagState::ready;
  const bool sl = flags_->selected(index_, now_s);
  const bool chosen = query.sel == Gen2Select::all || (query.sel == Gen2Select::sl) == sl;
  if (!chosen || is_b(query.session, now_s) != (query.target == Gen2Target::b)) return TagReply::nothing;
  session_ = query.session;
  q_ = query.q;
  s1_in_round_ = is_b(1, now_s);
  return draw_slot();
}

TagReply SlotTag::query_rep(std::uint8_t session, double now_s) {
  if (!powered_ || session != session_) return TagReply::nothing;
  count_if_acknowledged(now_s);
  if (state_ == TagState::reply) {  // nobody acknowledged it: its counter goes on below 0
    slot_ = kWrappedSlot;
    state_ = TagState::arbitrate;
  } else if (state_ == TagState::arbitrate && --slot_ == 0) {
    state_ = TagState::reply;
    rn16_ = static_cast<std::uint16_t>(random_.below(0x10000));
    return TagReply::rn16;
  }
  return TagReply::nothing;
}

TagReply SlotTag::query_adjust(std::uint8_t session, Gen2UpDn change, double now_s) {
  if (!powered_ || session != session_) return TagReply::nothing;
  count_if_acknowledged(now_s);
  if (state_ == TagState::ready) return TagReply::nothing;
  if (change == Gen2UpDn::up) q_ = static_cast<std::uint8_t>(std::min(q_ + 1, 15));
  if (change == Gen2UpDn::down) q_ = static_cast<std::uint8_t>(std::max(q_ - 1, 0));
  return draw_slot();
}

TagReply SlotTag::ack(std::uint16_t rn16) {
  if (!powered_ || state_ == TagState::ready) return TagReply::nothing;
  const bool mine = rn16 == rn16_ && (state_ == TagState::reply || state_ == TagState::acknowledged);
  if (!mine) {
    nak();
    return TagReply::nothing;
  }
  state_ = TagState::acknowledged;
  return TagReply::epc;
}

void SlotTag::nak() {
  if (!powered_ || state_ == TagState::ready) return;
  // A counter that has been used up waits beyond any frame for the next draw.
  if (state_ != TagState::arbitrate) slot_ = kWrappedSlot;
  state_ = TagState::arbitrate;
}

void SlotTag::select(std::uint8_t target, std::uint8_t action, bool matches, double now_s) {
  if (!powered_) return;
  state_ = TagState::ready;
  const Changes& changes = kActions[action & 7U];
  const Change change = matches ? changes.matching : changes.others;
  if (change == Change::none) return;
  if (target == 4) {
    flags_->select(index_, changed(flags_->selected(index_, now_s), change));
  } else if (target < 4) {
    const bool a = !is_b(target, now_s);
    flags_->set(index_, target, !changed(a, change), now_s, carrier_);
  }
}

}  // namespace forager::mocks
