#include "flight/mavlink_attitude.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "flight/frames.hpp"
#include "flight/mavlink/mavlink_wire.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;
using hal::Instant;

AttitudeSetpoint push(double thrust, double pitch_deg, double yaw_deg, Instant until = Instant{10s}) {
  return {hal::deg_to_rad(pitch_deg), hal::deg_to_rad(yaw_deg), thrust, until};
}

// The quaternion turns a vector of the FRD body into NED; forward and down are enough to know it by.
hal::Vec3 turned(const mavlink::SetAttitudeTarget& t, hal::Vec3 v) {
  const double w = t.q[0];
  const hal::Vec3 u{t.q[1], t.q[2], t.q[3]};
  const auto cross = [](hal::Vec3 a, hal::Vec3 b) {
    return hal::Vec3{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  };
  const hal::Vec3 t2 = 2.0 * cross(u, v);
  return v + w * t2 + cross(u, t2);
}

TEST(MavlinkAttitude, NoseDownPushesForwardAlongTheHeading) {
  const auto level = to_target(push(0.2, 0.0, 90.0));
  // Our left is the autopilot's west: y negative.
  const hal::Vec3 forward = turned(level, {1.0, 0.0, 0.0});
  EXPECT_NEAR(forward.x, 0.0, 1e-6);
  EXPECT_NEAR(forward.y, -1.0, 1e-6);

  const auto tilted = to_target(push(0.2, 20.0, 0.0));
  const hal::Vec3 thrust = turned(tilted, {0.0, 0.0, -1.0});  // against the body's down
  EXPECT_NEAR(thrust.x, std::sin(hal::deg_to_rad(20.0)), 1e-6) << "F_x = F sin(pitch), forward";
  EXPECT_NEAR(thrust.z, -std::cos(hal::deg_to_rad(20.0)), 1e-6) << "and the rest upward";
}

TEST(MavlinkAttitude, GivesAUnitQuaternionAndTheMaskArduCopterTakes) {
  for (const double yaw : {-179.0, -40.0, 0.0, 77.0, 180.0}) {
    const auto t = to_target(push(1.7, 33.0, yaw));
    double square = 0.0;
    for (const float part : t.q) square += static_cast<double>(part) * static_cast<double>(part);
    EXPECT_NEAR(square, 1.0, 1e-6);
    EXPECT_EQ(t.type_mask, 0x07) << "all three rates ignored, attitude and thrust given";
    EXPECT_EQ(t.thrust, 1.0F) << "clamped";
  }
}

TEST(MavlinkAttitude, IsSentAtTheIntervalAndAtOnceWhenThrustChanges) {
  MavlinkAttitude attitude(50ms);
  ASSERT_TRUE(attitude.set(push(0.2, 20.0, 0.0)));
  EXPECT_TRUE(attitude.due(Instant{0ms}));
  EXPECT_FALSE(attitude.due(Instant{40ms}));
  EXPECT_TRUE(attitude.due(Instant{50ms}));
  ASSERT_TRUE(attitude.set(push(0.0, 0.0, 0.0)));
  EXPECT_TRUE(attitude.due(Instant{51ms})) << "a cut of thrust does not wait";
}

TEST(MavlinkAttitude, IsNeverSentFromItsEndOn) {
  MavlinkAttitude attitude(20ms);
  ASSERT_TRUE(attitude.set(push(0.2, 20.0, 0.0, Instant{100ms})));
  EXPECT_TRUE(attitude.due(Instant{99ms}));
  EXPECT_FALSE(attitude.due(Instant{100ms}));
  EXPECT_TRUE(attitude.update(Instant{100ms}));
  EXPECT_FALSE(attitude.update(Instant{101ms})) << "said once";
  EXPECT_FALSE(attitude.is_set());
}

TEST(MavlinkAttitude, DropsWhatIsNotANumberAndWhatWasThere) {
  MavlinkAttitude attitude(20ms);
  ASSERT_TRUE(attitude.set(push(0.2, 20.0, 0.0)));
  EXPECT_FALSE(attitude.set(push(std::numeric_limits<double>::quiet_NaN(), 20.0, 0.0)));
  EXPECT_FALSE(attitude.due(Instant{0ms}));
}

}  // namespace
}  // namespace forager::flight
