// What the pair does when a brake, an output or the floor does not do what it should.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "servo/brakes.hpp"
#include "tests/servo/brakes_rig.hpp"

namespace forager::servo {
namespace {

using testing::HasSubstr;

// A brake that obeys at once and whose sensor a test can hold.
class MeasuredBrake final : public BrakeActuator {
 public:
  std::optional<double> stuck_at;
  void halt() noexcept override { told_ = 1.0; }

 private:
  hal::Result<> do_move(double fraction, hal::Instant) override {
    told_ = fraction;
    return {};
  }
  [[nodiscard]] double do_commanded() const override { return told_; }
  [[nodiscard]] std::optional<double> do_measured() const override { return stuck_at.value_or(told_); }
  [[nodiscard]] std::string_view do_name() const override { return "measured brake"; }
  double told_ = 0.0;
};

TEST_F(Brakes, AnOutputThatFailsStopsWithTheOtherBrakeInTheSameUpdate) {
  command(0.0, 0.0);
  run(500ms, VehicleMotion{0.8, 0.0, {}});
  group_.channel(0).disconnect();
  command(1.0, 0.0);
  run(20ms, VehicleMotion{0.8, 0.0, {}});
  EXPECT_EQ(BrakeState::faulted, brakes_->state());
  EXPECT_TRUE(brakes_->status().cut_thrust);
  EXPECT_EQ(BrakeFaultKind::output, brakes_->status().left.kind);
  EXPECT_FALSE(brakes_->status().right);
  run(100ms, VehicleMotion{0.8, -0.1, {}});
  EXPECT_TRUE(right_locked());
  EXPECT_EQ(1U, journal_.count("faulted: left brake, output: "));
}

// The vehicle pivots about the one wheel that holds: the yaw towards it must not grow into a spin.
TEST_F(Brakes, OneBrakeAloneIsLetGoWhileTheVehicleYawsTooFastTowardsIt) {
  command(0.0, 0.0);
  run(500ms);
  group_.channel(0).disconnect();
  command(0.5, 0.0);
  run(200ms, VehicleMotion{0.8, -0.1, {}});
  EXPECT_TRUE(right_locked());
  run(200ms, VehicleMotion{0.7, -0.5, {}});
  EXPECT_TRUE(right_open());
  run(200ms, VehicleMotion{0.6, -0.2, {}});
  EXPECT_TRUE(right_locked());
  run(200ms, VehicleMotion{0.5, +0.9, {}});  // it turns about the other one, which is stuck locked
  EXPECT_TRUE(right_locked());
  run(200ms, VehicleMotion{0.0, -0.01, {}});
  run(200ms, VehicleMotion{0.0, -0.9, {}});  // once it has stood, it stays locked
  EXPECT_TRUE(right_locked());
}

TEST_F(Brakes, WithoutAPoseOneBrakeIsPressedInPulsesAndThenForGood) {
  command(0.0, 0.0);
  run(500ms);
  group_.channel(1).disconnect();
  command(0.0, 0.5);
  int locked = 0;
  int open = 0;
  for (int i = 0; i < 120; ++i) {
    run(20ms);
    locked += left_locked() ? 1 : 0;
    open += left_open() ? 1 : 0;
  }
  EXPECT_GT(locked, 0);
  EXPECT_GT(open, locked);
  run(3s);
  EXPECT_TRUE(left_locked());
  run(1s);
  EXPECT_TRUE(left_locked());
}

TEST_F(Brakes, WithBothBrakesFailedBothAreToldToLockAgainAndAgain) {
  command(0.0, 0.0);
  run(500ms);
  group_.channel(0).disconnect();
  group_.channel(1).disconnect();
  command(1.0, 1.0);
  run(500ms);
  EXPECT_EQ(BrakeState::faulted, brakes_->state());
  EXPECT_THAT(brakes_->status().reason, HasSubstr("no brake is left"));
  group_.channel(0).disconnect(false);
  group_.channel(1).disconnect(false);
  run(300ms);
  EXPECT_TRUE(left_locked() && right_locked());
}

TEST_F(Brakes, AFaultStaysUntilSomebodyClearsIt) {
  EXPECT_EQ(hal::ErrorCode::invalid_state, brakes_->clear_fault(now_).error().code);
  command(0.0, 0.0);
  run(500ms);
  group_.channel(0).fail_next({hal::ErrorCode::no_ack, "chip", "write", "no answer", ""});
  command(1.0, 1.0);
  run(5s);
  EXPECT_EQ(BrakeState::faulted, brakes_->state());
  command(0.0, 0.0);
  run(500ms);
  EXPECT_EQ(BrakeState::faulted, brakes_->state());
  ASSERT_TRUE(brakes_->clear_fault(now_));
  run(500ms);
  EXPECT_TRUE(left_locked() && right_locked());
  command(0.0, 0.0);
  run(500ms);
  EXPECT_TRUE(left_open() && right_open());
}

TEST_F(Brakes, ALockedWheelThatMovesIsSlipOnItsSide) {
  command(1.0, 0.0);
  // Pivoting about the left wheel: v = w r. That is how it should be.
  run(2s, VehicleMotion{0.25, 0.5, {}});
  EXPECT_EQ(BrakeState::following, brakes_->state());
  command(1.0, 0.0);
  run(400ms, VehicleMotion{0.25, 0.0, {}});  // going straight on: the left wheel rolls
  EXPECT_EQ(BrakeFaultKind::slip, brakes_->status().left.kind);
  EXPECT_FALSE(brakes_->status().right);
}

TEST_F(Brakes, StoppingFromSpeedIsNoSlip) {
  command(0.0, 0.0);
  run(1s, VehicleMotion{0.3, 0.0, {}});
  command(1.0, 1.0);
  run(300ms, VehicleMotion{0.2, 0.0, {}});
  run(2s, VehicleMotion{0.02, 0.0, {}});
  EXPECT_EQ(BrakeState::following, brakes_->state());
}

TEST_F(Brakes, AnOpenWheelThatStandsWhileTheOtherTurnsIsStuck) {
  command(0.0, 0.0);
  run(300ms, VehicleMotion{0.25, 0.0, {}});
  run(2s, VehicleMotion{0.25, -0.5, {}});  // turns right about the right wheel, which is open
  EXPECT_EQ(BrakeFaultKind::drag, brakes_->status().right.kind);
  EXPECT_FALSE(brakes_->status().left);
  EXPECT_TRUE(left_locked());  // both hold now: the one by itself, the other as told
}

TEST_F(Brakes, MotionThatIsOldOrNoNumberAccusesNobody) {
  command(1.0, 0.0);
  brakes_->observe({0.5, 0.0, now_});
  run(2s);
  run(1s, VehicleMotion{std::nan(""), 0.0, {}});
  EXPECT_EQ(BrakeState::following, brakes_->state());
}

TEST(MeasuredBrakes, ABrakeThatMeasuresItselfElsewhereIsFound) {
  mocks::TextJournal journal;
  MeasuredBrake left;
  MeasuredBrake right;
  hal::Instant now(1s);
  BrakePair brakes(left, right, journal, {}, now);
  const auto run = [&](hal::Duration time) {
    for (const hal::Instant end = now + time; now < end; now += 20ms) brakes.update(now);
  };
  brakes.command({0.0, 0.0, now + 60s});
  run(1s);
  EXPECT_EQ(BrakeState::following, brakes.state());
  right.stuck_at = 0.0;
  run(1s);
  EXPECT_EQ(BrakeState::following, brakes.state());  // it is where it was told to be
  brakes.command({1.0, 1.0, now + 60s});
  run(300ms);
  EXPECT_EQ(BrakeState::following, brakes.state());  // it is given time to move
  run(400ms);
  EXPECT_EQ(BrakeFaultKind::mismatch, brakes.status().right.kind);
  EXPECT_THAT(brakes.status().reason, HasSubstr("told 1.00 and measures 0.00"));
}

}  // namespace
}  // namespace forager::servo
