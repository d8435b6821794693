#include "mocks/truth_feed.hpp"

#include <gtest/gtest.h>

#include "hal/random.hpp"
#include "hal/units.hpp"
#include "mocks/memory_stream.hpp"

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;

class Puppet : public TrueBody {
 public:
  const BodyState& state() const override { return body; }
  BodyState body;
};

TEST(TruthFeed, TheFollowerIsWhereTheBodyIs) {
  MemoryStreamPair line("truth", MemoryStreamKind::datagrams);
  Puppet puppet;
  TruthFeed feed(puppet, line.near(), 20ms);
  TruthFollower follower(line.far());
  hal::Random random(5);
  hal::Instant now(3s);
  for (int i = 0; i < 500; ++i) {
    puppet.body = {.pose = {{random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(0, 6)},
                            random.uniform(-3.1, 3.1),
                            random.uniform(-1, 1),
                            random.uniform(-1, 1)},
                   .velocity_world_m_s = {random.normal(), random.normal(), random.normal()},
                   .yaw_rate_rad_s = random.normal(),
                   .armed = random.chance(0.5),
                   .on_ground = random.chance(0.5)};
    feed.update(now);
    follower.update(now);
    const BodyState& told = follower.state();
    EXPECT_LT(hal::norm(told.pose.position - puppet.body.pose.position), 2e-5);
    EXPECT_NEAR(told.pose.yaw_rad, puppet.body.pose.yaw_rad, 1e-6);
    EXPECT_NEAR(told.pose.pitch_rad, puppet.body.pose.pitch_rad, 1e-6);
    EXPECT_NEAR(told.pose.roll_rad, puppet.body.pose.roll_rad, 1e-6);
    EXPECT_LT(hal::norm(told.velocity_world_m_s - puppet.body.velocity_world_m_s), 1e-5);
    EXPECT_NEAR(told.yaw_rate_rad_s, puppet.body.yaw_rate_rad_s, 1e-6);
    EXPECT_EQ(told.armed, puppet.body.armed);
    EXPECT_EQ(told.on_ground, puppet.body.on_ground);
    EXPECT_EQ(follower.told_at(), now);
    now += 20ms;
  }
}

TEST(TruthFeed, SendsAtItsIntervalAndTheFollowerKnowsWhenItIsDeaf) {
  MemoryStreamPair line("truth", MemoryStreamKind::datagrams);
  Puppet puppet;
  TruthFeed feed(puppet, line.near(), 50ms);
  TruthFollower follower(line.far());
  hal::Instant now;
  follower.update(now);
  EXPECT_FALSE(follower.fresh(now, 1h));
  for (int i = 0; i < 100; ++i) {
    now += 10ms;
    feed.update(now);
    follower.update(now);
  }
  EXPECT_EQ(feed.sent(), 20u);
  EXPECT_TRUE(follower.fresh(now, 50ms));
  line.cut(true);
  for (int i = 0; i < 100; ++i) {
    now += 10ms;
    feed.update(now);
    follower.update(now);
  }
  EXPECT_FALSE(follower.fresh(now, 500ms));
}

TEST(TruthFeed, TheWireSaysForwardRightDown) {
  BodyState body;
  body.pose = {{1, 2, 3}, hal::kPi / 2};
  body.velocity_world_m_s = {0, 1, 0};  // straight ahead, as it faces left
  const MavlinkPayload p = encode_truth(body, hal::Instant(1s));
  EXPECT_EQ(p.get<std::uint64_t>(0), 1000000u);
  EXPECT_FLOAT_EQ(p.get<float>(8), 1.0F);
  EXPECT_FLOAT_EQ(p.get<float>(12), -2.0F);
  EXPECT_FLOAT_EQ(p.get<float>(16), -3.0F);
  EXPECT_NEAR(p.f32(20), std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(p.f32(32), -std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(p.f32(36), 1.0, 1e-6);
  EXPECT_NEAR(p.f32(40), 0.0, 1e-6);
  EXPECT_EQ(p.get<std::uint8_t>(228), 20);
  EXPECT_EQ(p.get<std::uint8_t>(229), 12);
}

TEST(TruthFeed, RefusesOtherFramesAndNonsense) {
  const MavlinkPayload good = encode_truth({}, {});
  ASSERT_TRUE(decode_truth(good));
  MavlinkPayload ned = good;
  ned.put(228, std::uint8_t{1});
  EXPECT_FALSE(decode_truth(ned));
  MavlinkPayload twisted = good;
  twisted.f32(20, 2.0);
  EXPECT_FALSE(decode_truth(twisted));
  MavlinkPayload nowhere = good;
  nowhere.f32(8, NAN);
  EXPECT_FALSE(decode_truth(nowhere));
}

}  // namespace
}  // namespace forager::mocks
