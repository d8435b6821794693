#pragma once

#include <algorithm>

#include "hal/time.hpp"

namespace forager::reader {

// How long to wait before the next try: first, twice that, ... up to cap; from the start again after a
// success. No jitter: one client talks to one reader, and a run must repeat to the byte.
class Backoff {
 public:
  // Both positive; first <= cap.
  Backoff(hal::Duration first, hal::Duration cap) : first_(std::min(first, cap)), cap_(cap), next_(first_) {}

  // The wait before the coming try.
  [[nodiscard]] hal::Duration next() {
    const hal::Duration wait = next_;
    next_ = next_ > cap_ / 2 ? cap_ : next_ * 2;
    return wait;
  }
  void reset() { next_ = first_; }

 private:
  hal::Duration first_;
  hal::Duration cap_;
  hal::Duration next_;
};

}  // namespace forager::reader
