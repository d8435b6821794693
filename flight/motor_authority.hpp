#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "hal/error.hpp"

namespace forager::flight {

// The right to spin one vehicle's motors. Move-only, handed out by a MotorBay to one holder at a time, given
// back when it is destroyed. Neither an EscBank nor an autopilot bridge can be made without it, so whoever
// makes both from one bay cannot arm through the autopilot and pulse the ESCs of the same vehicle at once.
// One bay for each vehicle is the program's part: two bays, or two programs, know nothing of each other.
class MotorAuthority {
 public:
  MotorAuthority(MotorAuthority&&) noexcept = default;
  MotorAuthority& operator=(MotorAuthority&& other) noexcept {
    std::swap(holder_, other.holder_);  // what it held before goes back with `other`
    return *this;
  }
  MotorAuthority(const MotorAuthority&) = delete;
  MotorAuthority& operator=(const MotorAuthority&) = delete;
  ~MotorAuthority() {
    if (holder_) holder_->clear();
  }

  // False only after it was moved from.
  [[nodiscard]] bool valid() const { return holder_ != nullptr; }

 private:
  friend class MotorBay;
  explicit MotorAuthority(std::shared_ptr<std::string> holder) : holder_(std::move(holder)) {}

  std::shared_ptr<std::string> holder_;  // empty text: nobody; shared with the bay
};

// The motors of one vehicle, as a thing that has one owner at a time.
class MotorBay {
 public:
  MotorBay() = default;
  MotorBay(const MotorBay&) = delete;
  MotorBay& operator=(const MotorBay&) = delete;

  // `who` is for the refusal of the next one who asks. Errors: busy (somebody holds it; says who).
  [[nodiscard]] hal::Result<MotorAuthority> claim(std::string_view who) {
    if (!holder_->empty())
      return hal::fail(hal::ErrorCode::busy, "motors", "claim for " + std::string(who),
                       "they belong to " + *holder_, "end " + *holder_ + " first");
    *holder_ = who.empty() ? "somebody" : who;
    return MotorAuthority(holder_);
  }
  // Who holds it; empty if nobody.
  [[nodiscard]] const std::string& holder() const { return *holder_; }

 private:
  std::shared_ptr<std::string> holder_ = std::make_shared<std::string>();
};

}  // namespace forager::flight
