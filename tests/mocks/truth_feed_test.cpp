#include "mocks/truth_feed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <vector>

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

// Keeps to whoever spoke first since it was opened, as a listening UDP socket does.
class FirstCallerOnly : public hal::ByteStream {
 public:
  struct Datagram {
    int caller;
    std::vector<std::byte> bytes;
  };
  std::deque<Datagram> arrived;

 private:
  hal::Result<> do_open() override {
    open_ = true;
    caller_ = 0;
    return {};
  }
  hal::Result<hal::StreamState> do_poll() override {
    if (!open_) return hal::StreamState::closed;
    if (caller_ == 0 && !arrived.empty()) caller_ = arrived.front().caller;
    return caller_ == 0 ? hal::StreamState::opening : hal::StreamState::open;
  }
  hal::Result<std::size_t> do_read(std::span<std::byte> into) override {
    while (!arrived.empty()) {
      const Datagram next = std::move(arrived.front());
      arrived.pop_front();
      if (next.caller != caller_) continue;
      std::ranges::copy(next.bytes, into.begin());
      return next.bytes.size();
    }
    return std::size_t{0};
  }
  hal::Result<std::size_t> do_write(std::span<const std::byte>) override { return std::size_t{0}; }
  void do_close() override { open_ = false; }
  std::string_view do_name() const override { return "first caller only"; }

  bool open_ = false;
  int caller_ = 0;
};

std::vector<std::byte> truth_datagram(double x_m, hal::Instant now) {
  BodyState body;
  body.pose.position = {x_m, 0, 0};
  MavlinkPeerPacker packer(255, 250);
  const auto frame = packer.pack(peer::kOdometry, encode_truth(body, now));
  return {frame.begin(), frame.end()};
}

TEST(TruthFeed, TheFollowerHearsATellerThatWasStartedAnew) {
  FirstCallerOnly line;
  TruthFollower follower(line);
  hal::Instant now(1s);
  const auto tell_for = [&](hal::Duration time, int caller, double x_m) {
    for (const hal::Instant end = now + time; now < end; now += 20ms) {
      line.arrived.push_back({caller, truth_datagram(x_m, now)});
      follower.update(now);
    }
  };
  tell_for(1s, 1, 1.0);
  EXPECT_NEAR(follower.state().pose.position.x, 1.0, 1e-5);
  tell_for(5s, 2, 2.0);
  EXPECT_NEAR(follower.state().pose.position.x, 2.0, 1e-5) << "still waits for the teller that has gone";
  EXPECT_TRUE(follower.fresh(now, 50ms));
}

TEST(TruthFeed, AStrangerWhoWasFirstDoesNotKeepTheFollowerDeaf) {
  FirstCallerOnly line;
  TruthFollower follower(line);
  hal::Instant now(1s);
  for (int i = 0; i < 50; ++i, now += 20ms) {
    line.arrived.push_back({7, {std::byte{0xFD}, std::byte{9}, std::byte{0}}});
    follower.update(now);
  }
  EXPECT_FALSE(follower.told_at());
  for (int i = 0; i < 200; ++i, now += 20ms) {
    line.arrived.push_back({1, truth_datagram(3.0, now)});
    follower.update(now);
  }
  EXPECT_TRUE(follower.fresh(now, 50ms));
  EXPECT_NEAR(follower.state().pose.position.x, 3.0, 1e-5);
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
