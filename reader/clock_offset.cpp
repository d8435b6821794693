#include "reader/clock_offset.hpp"

#include <algorithm>
#include <cstdlib>

namespace forager::reader {
namespace {

using std::chrono::milliseconds;

constexpr hal::Duration kStampResolution = milliseconds(1);  // stamps are whole milliseconds
constexpr std::int64_t kDriftParts = 5000;                   // 200 ppm: a poor crystal in the cold
constexpr std::int64_t kFarMs = 30LL * 366 * 86'400'000;     // keeps every difference inside int64 ns

}  // namespace

ClockOffset::Outcome ClockOffset::add(hal::Instant sent, hal::Instant received, std::int64_t reader_ms) {
  const hal::Duration half = std::max(hal::Duration::zero(), received - sent) / 2;
  const hal::Instant middle = sent + half;
  const hal::Duration bound = half + kStampResolution;
  Outcome outcome = Outcome::first;
  if (known_) {
    const std::int64_t expected_ms = to_reader_ms(middle);
    const hal::Duration allowed = bound + uncertainty(middle);
    const std::int64_t apart_ms = reader_ms - expected_ms;
    if (std::abs(apart_ms) > std::chrono::ceil<milliseconds>(allowed).count()) {
      outcome = Outcome::stepped;
      last_step_ms_ = apart_ms;
      ++steps_;
    } else if (bound <= uncertainty(middle)) {
      outcome = Outcome::better;
    } else {
      return Outcome::kept;
    }
  }
  known_ = true;
  reader_ms_ = reader_ms;
  local_ = middle;
  bound_ = bound;
  return outcome;
}

hal::Instant ClockOffset::to_instant(std::int64_t reader_ms, hal::Instant fallback) const {
  if (!known_) return fallback;
  const std::int64_t ahead_ms = reader_ms - reader_ms_;
  if (ahead_ms > kFarMs || ahead_ms < -kFarMs) return fallback;
  return local_ + milliseconds(ahead_ms);
}

std::int64_t ClockOffset::to_reader_ms(hal::Instant when) const {
  if (!known_) return 0;
  return reader_ms_ + std::chrono::round<milliseconds>(when - local_).count();
}

hal::Duration ClockOffset::uncertainty(hal::Instant when) const {
  const hal::Duration age = when > local_ ? when - local_ : local_ - when;
  return bound_ + age / kDriftParts;
}

}  // namespace forager::reader
