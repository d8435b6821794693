#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "hal/error.hpp"

namespace forager::flight {

class MotorBay;

// The right to spin one vehicle's motors. Move-only, handed out by a MotorBay to one holder at a time, given
// back when it is destroyed. Neither an EscBank nor an autopilot bridge can be made without it, so no program
// that compiles can arm through the autopilot and pulse the ESCs of the same vehicle at once.
class MotorAuthority {
 public:
  MotorAuthority(MotorAuthority&& other) noexcept : bay_(std::exchange(other.bay_, nullptr)) {}
  MotorAuthority& operator=(MotorAuthority&& other) noexcept;
  MotorAuthority(const MotorAuthority&) = delete;
  MotorAuthority& operator=(const MotorAuthority&) = delete;
  ~MotorAuthority() { give_back(); }

  // False only after it was moved from.
  [[nodiscard]] bool valid() const { return bay_ != nullptr; }

 private:
  friend class MotorBay;
  explicit MotorAuthority(MotorBay& bay) : bay_(&bay) {}
  void give_back() noexcept;

  MotorBay* bay_;
};

// The motors of one vehicle, as a thing that has one owner. Must outlive the authority it hands out.
class MotorBay {
 public:
  MotorBay() = default;
  MotorBay(const MotorBay&) = delete;
  MotorBay& operator=(const MotorBay&) = delete;

  // `who` is for the refusal of the next one who asks. Errors: busy (somebody holds it; says who).
  [[nodiscard]] hal::Result<MotorAuthority> claim(std::string_view who) {
    if (!holder_.empty())
      return hal::fail(hal::ErrorCode::busy, "motors", "claim for " + std::string(who),
                       holder_ + " drives them", "end " + holder_ + " first; never let two drive one motor");
    holder_ = who.empty() ? "somebody" : who;
    return MotorAuthority(*this);
  }
  // Who holds it; empty if nobody.
  [[nodiscard]] const std::string& holder() const { return holder_; }

 private:
  friend class MotorAuthority;
  std::string holder_;
};

inline void MotorAuthority::give_back() noexcept {
  if (bay_ != nullptr) bay_->holder_.clear();
  bay_ = nullptr;
}

inline MotorAuthority& MotorAuthority::operator=(MotorAuthority&& other) noexcept {
  if (this != &other) {
    give_back();
    bay_ = std::exchange(other.bay_, nullptr);
  }
  return *this;
}

}  // namespace forager::flight
