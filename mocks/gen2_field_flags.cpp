#include "mocks/gen2_field_flags.hpp"

#include <limits>

#include "hal/random.hpp"

namespace forager::mocks {
namespace {

constexpr double kLongAgo = -std::numeric_limits<double>::infinity();
constexpr std::uint8_t kSl = 4;

constexpr std::uint8_t bit_of(int session) { return session == 3 ? 2 : 1; }

}  // namespace

SessionFlags::SessionFlags(std::size_t tags, const AirParameters& air, std::uint64_t seed)
    : seed_(seed),
      s1_min_s_(air.s1_persistence_min_s),
      s1_max_s_(air.s1_persistence_max_s),
      s2_min_s_(air.s2_persistence_min_s),
      s2_max_s_(air.s2_persistence_max_s),
      s0_dwell_(tags, 0),
      s1_until_(tags, kLongAgo),
      held_(tags, 0),
      powered_(tags, 0),
      power_lost_(tags, kLongAgo),
      quiet_until_(tags, kLongAgo) {}

double SessionFlags::s1_persistence_s(std::uint32_t tag) const {
  return hal::Random::stream(seed_, 2ULL * tag).uniform(s1_min_s_, s1_max_s_);
}

double SessionFlags::s2_persistence_s(std::uint32_t tag) const {
  return hal::Random::stream(seed_, 2ULL * tag + 1).uniform(s2_min_s_, s2_max_s_);
}

bool SessionFlags::held(std::uint32_t tag, std::uint8_t bit, double now_s) const {
  return (held_[tag] & bit) != 0 && (powered_[tag] != 0 || now_s - power_lost_[tag] < s2_persistence_s(tag));
}

void SessionFlags::hold(std::uint32_t tag, std::uint8_t bit, bool asserted) {
  held_[tag] = static_cast<std::uint8_t>(asserted ? held_[tag] | bit : held_[tag] & ~bit);
  powered_[tag] = 1;
  needs_power_watch_ = true;
}

bool SessionFlags::is_b(std::uint32_t tag, int session, double now_s, std::uint64_t dwell) const {
  switch (session) {
    case 0:
      return s0_dwell_[tag] == dwell;
    case 1:
      return s1_until_[tag] > now_s;
    default:
      return held(tag, bit_of(session), now_s);
  }
}

void SessionFlags::set(std::uint32_t tag, int session, bool b, double now_s, std::uint64_t dwell) {
  switch (session) {
    case 0:
      s0_dwell_[tag] = b ? dwell : 0;
      break;
    case 1:
      s1_until_[tag] = b ? now_s + s1_persistence_s(tag) : kLongAgo;
      break;
    default:
      hold(tag, bit_of(session), b);
  }
}

bool SessionFlags::selected(std::uint32_t tag, double now_s) const { return held(tag, kSl, now_s); }

void SessionFlags::select(std::uint32_t tag, bool asserted) { hold(tag, kSl, asserted); }

bool SessionFlags::answers(std::uint32_t tag, int session, char target, double now_s,
                           std::uint64_t dwell) const {
  if (target == '*') return quiet_until_[tag] <= now_s;
  return is_b(tag, session, now_s, dwell) == (target == 'B');
}

void SessionFlags::singulate(std::uint32_t tag, int session, char target, double now_s, std::uint64_t dwell,
                             double quiet_until_s) {
  if (target == '*') quiet_until_[tag] = quiet_until_s;
  set(tag, session, !is_b(tag, session, now_s, dwell), now_s, dwell);
}

void SessionFlags::set_power(std::uint32_t tag, bool powered, double now_s) {
  // Too late: it wakes up with the flags back at A and SL deasserted.
  if (powered && powered_[tag] == 0 && held_[tag] != 0 && now_s - power_lost_[tag] >= s2_persistence_s(tag))
    held_[tag] = 0;
  if (!powered && powered_[tag] != 0) power_lost_[tag] = now_s;
  powered_[tag] = powered ? 1 : 0;
}

}  // namespace forager::mocks
