#include "flight/step_flight.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hal/units.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;

// A body that follows the goal at once, on a way of four metres straight ahead.
class StepFlightOnItsWay : public testing::Test {
 protected:
  void SetUp() override {
    body_.position.z = 1.8;
    flight_.hold(body_);
    Step step;
    step.length_m = 4.0;
    step.height_m = 1.8;
    flight_.begin(step, body_, 0.0, now_);
    while (body_.position.x < 1.0) ASSERT_EQ(tick(WayAhead::clear), StepOutcome::flying);
  }
  StepOutcome tick(WayAhead way) {
    now_ += 50ms;
    GuardVerdict verdict;
    verdict.way = way;
    verdict.stamp = now_;
    const double before = body_.position.x;
    const StepOutcome outcome = flight_.update(body_, {speed_m_s_, 0.0, 0.0}, verdict, now_);
    body_.position.x = flight_.setpoint(now_).position_world.x;
    speed_m_s_ = (body_.position.x - before) / 0.05;
    return outcome;
  }
  // Until it has stopped; gives how far it went on.
  double run_out(WayAhead way) {
    const double from = body_.position.x;
    StepOutcome outcome = StepOutcome::flying;
    for (int i = 0; i < 100 && outcome == StepOutcome::flying; ++i) outcome = tick(way);
    EXPECT_EQ(outcome, StepOutcome::blocked);
    return body_.position.x - from;
  }

  StepFlight flight_{StepFlightConfig{}};
  hal::Pose body_;
  double speed_m_s_ = 0.0;
  hal::Instant now_;
};

TEST_F(StepFlightOnItsWay, ArrivesWhenTheWayStaysClear) {
  StepOutcome outcome = StepOutcome::flying;
  for (int i = 0; i < 400 && outcome == StepOutcome::flying; ++i) outcome = tick(WayAhead::clear);
  EXPECT_EQ(outcome, StepOutcome::arrived);
  EXPECT_NEAR(body_.position.x, 4.0, 0.2);
}

TEST_F(StepFlightOnItsWay, StopsForWhatItSees) { EXPECT_LT(run_out(WayAhead::blocked), 0.2); }

TEST_F(StepFlightOnItsWay, StopsBlind) { EXPECT_LT(run_out(WayAhead::blind), 0.2); }

TEST_F(StepFlightOnItsWay, StopsWhenItLooksElsewhereThanItFlies) {
  body_.yaw_rad = hal::deg_to_rad(10.0);
  EXPECT_EQ(tick(WayAhead::clear), StepOutcome::flying);
  body_.yaw_rad = hal::deg_to_rad(-20.0);
  EXPECT_LT(run_out(WayAhead::clear), 0.2);
}

}  // namespace
}  // namespace forager::flight
