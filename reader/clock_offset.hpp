#pragma once

#include <cstdint>

#include "hal/time.hpp"

namespace forager::reader {

// Where the reader's clock (Unix milliseconds, possibly years off, possibly set anew while we run) stands on
// the run's time line. Fed with stamped replies: the stamp was taken somewhere between request and reply, so
// the best estimate is the midpoint with half the delay as error bound (Cristian 1989), and the reply with
// the smallest bound wins. A bound grows with its age, because clocks drift. A stamp that lies outside both
// bounds together cannot come from a clock that ran on: that is a step, and the old estimate is dropped.
class ClockOffset {
 public:
  enum class Outcome : std::uint8_t {
    first,    // nothing was known before
    better,   // replaces the estimate
    kept,     // agrees with the estimate, but is no better
    stepped,  // the reader's clock was set; last_step_ms() says how far
  };

  // reader_ms: the stamp in the reply. received < sent is taken as no delay.
  Outcome add(hal::Instant sent, hal::Instant received, std::int64_t reader_ms);

  [[nodiscard]] bool known() const { return known_; }
  // Reader time on the run's time line. Without an estimate, or more than 30 years away from it: `fallback`.
  [[nodiscard]] hal::Instant to_instant(std::int64_t reader_ms, hal::Instant fallback) const;
  // What the reader's clock shows at an instant, in Unix milliseconds; 0 without an estimate.
  [[nodiscard]] std::int64_t to_reader_ms(hal::Instant when) const;
  // Bound on the error of both at an instant.
  [[nodiscard]] hal::Duration uncertainty(hal::Instant when) const;
  [[nodiscard]] std::int64_t last_step_ms() const { return last_step_ms_; }
  [[nodiscard]] std::uint32_t steps() const { return steps_; }

 private:
  bool known_ = false;
  std::int64_t reader_ms_ = 0;  // the sample: reader clock ...
  hal::Instant local_;          // ... at this instant ...
  hal::Duration bound_{};       // ... give or take
  std::int64_t last_step_ms_ = 0;
  std::uint32_t steps_ = 0;
};

}  // namespace forager::reader
