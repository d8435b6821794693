#pragma once

#include <cstdint>

#include "hal/time.hpp"

namespace forager::flight {

// Watches over the owner of something that moves.
//
//   unfed --feed--> alive --no feed for `allowed`--> expired --feed--> alive
//
// unfed: nobody has taken charge yet; nothing is to be sent. alive: go on. expired: the owner hangs or is
// gone; commands stop and are not taken up again when it returns: it must command anew.
class Deadman {
 public:
  enum class State : std::uint8_t { unfed, alive, expired };

  explicit Deadman(hal::Duration allowed) : allowed_(allowed) {}

  void feed(hal::Instant now) {
    last_feed_ = now;
    state_ = State::alive;
  }
  // True at the one update that finds the owner gone.
  bool update(hal::Instant now) {
    if (state_ != State::alive || now - last_feed_ < allowed_) return false;
    state_ = State::expired;
    return true;
  }
  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] bool alive() const { return state_ == State::alive; }

 private:
  hal::Duration allowed_;
  hal::Instant last_feed_{};
  State state_ = State::unfed;
};

}  // namespace forager::flight
