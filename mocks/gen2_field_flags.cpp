#include "mocks/gen2_field_flags.hpp"

#include <limits>

#include "hal/random.hpp"

namespace forager::mocks {
namespace {

constexpr double kLongAgo = -std::numeric_limits<double>::infinity();

}  // namespace

SessionFlags::SessionFlags(std::size_t tags, const AirParameters& air, std::uint64_t seed)
    : s0_dwell_(tags, 0),
      s1_until_(tags, kLongAgo),
      powered_(tags, 0),
      power_lost_(tags, kLongAgo),
      quiet_until_(tags, kLongAgo),
      s1_persistence_(tags),
      s2_persistence_(tags) {
  for (auto& held : held_) held.assign(tags, 0);
  hal::Random random(seed);
  for (std::size_t i = 0; i < tags; ++i) {
    s1_persistence_[i] = random.uniform(air.s1_persistence_min_s, air.s1_persistence_max_s);
    s2_persistence_[i] = random.uniform(air.s2_persistence_min_s, air.s2_persistence_max_s);
  }
}

bool SessionFlags::is_b(std::uint32_t tag, int session, double now_s, std::uint64_t dwell) const {
  switch (session) {
    case 0:
      return s0_dwell_[tag] == dwell;
    case 1:
      return s1_until_[tag] > now_s;
    default:
      return held_[session == 3][tag] != 0 &&
             (powered_[tag] != 0 || now_s - power_lost_[tag] < s2_persistence_[tag]);
  }
}

bool SessionFlags::answers(std::uint32_t tag, int session, char target, double now_s,
                           std::uint64_t dwell) const {
  if (target == '*') return quiet_until_[tag] <= now_s;
  return is_b(tag, session, now_s, dwell) == (target == 'B');
}

void SessionFlags::singulate(std::uint32_t tag, int session, char target, double now_s, std::uint64_t dwell,
                             double quiet_until_s) {
  const bool to_b = !is_b(tag, session, now_s, dwell);
  if (target == '*') quiet_until_[tag] = quiet_until_s;
  switch (session) {
    case 0:
      s0_dwell_[tag] = to_b ? dwell : 0;
      break;
    case 1:
      s1_until_[tag] = to_b ? now_s + s1_persistence_[tag] : kLongAgo;
      break;
    default:
      held_[session == 3][tag] = to_b ? 1 : 0;
      powered_[tag] = 1;
      needs_power_watch_ = true;
  }
}

void SessionFlags::set_power(std::uint32_t tag, bool powered, double now_s) {
  if (powered && powered_[tag] == 0 && now_s - power_lost_[tag] >= s2_persistence_[tag]) {
    // Too late: it wakes up with the flag back at A.
    held_[0][tag] = 0;
    held_[1][tag] = 0;
  }
  if (!powered && powered_[tag] != 0) power_lost_[tag] = now_s;
  powered_[tag] = powered ? 1 : 0;
}

}  // namespace forager::mocks
