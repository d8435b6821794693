#pragma once

#include <gtest/gtest.h>

#include <optional>

#include "mocks/fake_pwm.hpp"
#include "mocks/text_journal.hpp"
#include "servo/brakes.hpp"
#include "servo/pwm_brake.hpp"

namespace forager::servo {

using namespace std::chrono_literals;

// Two servo brakes of the laboratory on an exact timer, and the pair that commands them.
class Brakes : public testing::Test {
 protected:
  Brakes() { brakes_.emplace(left_, right_, journal_, BrakePairConfig{}, now_); }

  // Lets time pass in steps of a control loop; the vehicle does what `motion` says.
  void run(hal::Duration time, std::optional<VehicleMotion> motion = std::nullopt) {
    for (const hal::Instant end = now_ + time; now_ < end;) {
      now_ += 20ms;
      group_.tick(now_);
      if (motion) brakes_->observe({motion->forward_m_s, motion->yaw_rate_rad_s, now_});
      brakes_->update(now_);
    }
  }
  void command(double left, double right, hal::Duration lasting = 10s) {
    brakes_->command({left, right, now_ + lasting});
  }
  [[nodiscard]] bool left_locked() { return group_.channel(0).pulse() == hal::Duration(1725us); }
  [[nodiscard]] bool right_locked() { return group_.channel(1).pulse() == hal::Duration(1875us); }
  [[nodiscard]] bool left_open() { return group_.channel(0).pulse() == hal::Duration(1180us); }
  [[nodiscard]] bool right_open() { return group_.channel(1).pulse() == hal::Duration(1180us); }

  hal::Instant now_{1s};
  mocks::TextJournal journal_;
  mocks::FakePwmGroup group_{"timer", 2};
  PwmBrake left_ = PwmBrake::create(group_.channel(0), laboratory_left()).value();
  PwmBrake right_ = PwmBrake::create(group_.channel(1), laboratory_right()).value();
  std::optional<BrakePair> brakes_;
};

}  // namespace forager::servo
