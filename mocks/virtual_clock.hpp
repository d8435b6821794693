#pragma once

#include <algorithm>

#include "hal/time.hpp"

namespace forager::mocks {

// Time that only moves when somebody asks: sleeping jumps, so a run goes as fast as the machine allows and
// its times come out the same every time.
class VirtualClock final : public hal::Clock {
 public:
  explicit VirtualClock(hal::Instant start = {}) : now_(start) {}
  void advance(hal::Duration by) { now_ += std::max(by, hal::Duration::zero()); }

 private:
  hal::Instant do_now() const override { return now_; }
  void do_sleep_until(hal::Instant when) override { now_ = std::max(now_, when); }

  hal::Instant now_;
};

}  // namespace forager::mocks
