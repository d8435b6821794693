#include <gtest/gtest.h>

#include <cmath>

#include "flight/mavlink_autopilot.hpp"
#include "flight/vision_filter.hpp"
#include "hal/units.hpp"
#include "mocks/memory_stream.hpp"
#include "mocks/sim_autopilot.hpp"
#include "mocks/text_journal.hpp"
#include "tests/reader/allocation_count.hpp"

// The bridge and the vision filter fly the emulated vehicle; all judgements are about the true body.
namespace forager::flight {
namespace {

using namespace std::chrono_literals;

class Flight {
 public:
  explicit Flight(const mocks::SimAutopilotConfig& sim = {}, hal::Journal* journal = nullptr)
      : sim_(line_.far(), sim), ours_(make(journal != nullptr ? *journal : null_journal_)) {
    sim_.attach(nullptr, journal);
  }

  void run(hal::Duration time) {
    for (const hal::Instant end = now_ + time; now_ < end;) step();
  }
  template <class Condition>
  bool run_until(hal::Duration limit, Condition&& condition) {
    for (const hal::Instant end = now_ + limit; now_ < end && !condition();) step();
    return condition();
  }
  void step() {
    now_ += 20ms;
    sim_.update(now_);
    ours_->feed_deadman(now_);
    if (now_ >= next_frame_) see();
    ours_->update(now_);
  }

  bool ready() {
    return run_until(20s, [&] { return ours_->state().link_up && ours_->state().pose_valid; }) &&
           (run(3s), true);
  }
  bool take_off(double height_m) {
    const auto done = [&] { return ours_->request_state() != RequestState::pending; };
    ours_->request_guided(now_);
    if (!run_until(5s, done) || !run_until(3s, [&] { return ours_->state().guided; })) return false;
    ours_->request_arm(now_);
    if (!run_until(10s, done) || ours_->request_state() != RequestState::accepted) return false;
    run(1s);
    ours_->request_takeoff(height_m, now_);
    return run_until(20s, [&] { return body().position.z > height_m - 0.1; });
  }
  void go_to(hal::Vec3 place, double yaw_rad, hal::Duration time) {
    ours_->set_position({place, yaw_rad, now_ + time});
    run(time);
  }

  [[nodiscard]] const hal::Pose& body() const { return sim_.state().pose; }
  MavlinkAutopilot& ours() { return *ours_; }
  mocks::SimAutopilot& sim() { return sim_; }
  VisionFilter& filter() { return filter_; }
  [[nodiscard]] hal::Instant now() const { return now_; }
  hal::Vec3 vision_offset;  // a relocalisation of the camera

 private:
  std::unique_ptr<MavlinkAutopilot> make(hal::Journal& journal) {
    MavlinkConfig config;
    config.origin = GlobalOrigin{52.2, 0.12, 10.0};
    return std::move(
        MavlinkAutopilot::create(line_.near(), journal, config, now_, MotorBay().claim("autopilot").value())
            .value());
  }
  void see() {
    next_frame_ = now_ + 33ms;
    hal::PoseSample sample;
    sample.stamp = now_;
    sample.pose = body();
    sample.pose.position = sample.pose.position + vision_offset;
    if (const auto passed = filter_.update(sample, now_)) ours_->send_vision(*passed);
  }

  hal::Instant now_{100s};
  hal::NullJournal null_journal_;
  mocks::MemoryStreamPair line_{"udp autopilot", mocks::MemoryStreamKind::datagrams};
  mocks::SimAutopilot sim_;
  std::unique_ptr<MavlinkAutopilot> ours_;
  VisionFilter filter_{VisionFilterConfig{}};
  hal::Instant next_frame_{};
};

void expect_at(const hal::Pose& body, hal::Vec3 place, double yaw_rad) {
  EXPECT_NEAR(body.position.x, place.x, 0.2);
  EXPECT_NEAR(body.position.y, place.y, 0.2);
  EXPECT_NEAR(body.position.z, place.z, 0.2);
  EXPECT_NEAR(hal::angle_difference(body.yaw_rad, yaw_rad), 0.0, hal::deg_to_rad(15.0));
}

TEST(MavlinkFlight, FliesToPlacesAndHeadingsAndLands) {
  Flight flight;
  ASSERT_TRUE(flight.ready());
  ASSERT_TRUE(flight.take_off(1.5)) << flight.ours().request_detail();
  EXPECT_TRUE(flight.ours().state().in_air);
  flight.go_to({3.0, 1.0, 1.5}, hal::kPi / 2, 10s);
  expect_at(flight.body(), {3.0, 1.0, 1.5}, hal::kPi / 2);
  flight.go_to({0.0, -1.0, 1.0}, hal::kPi, 10s);
  expect_at(flight.body(), {0.0, -1.0, 1.0}, hal::kPi);
  expect_at(flight.ours().state().pose_world, {0.0, -1.0, 1.0}, hal::kPi);
  flight.ours().request_land(flight.now());
  EXPECT_TRUE(flight.run_until(20s, [&] { return !flight.ours().state().armed; }));
  EXPECT_LT(flight.body().position.z, 0.1);
  EXPECT_EQ(flight.sim().vehicle().hard_landings(), 0U);
}

TEST(MavlinkFlight, FliesBodyVelocitiesWhereTheNosePoints) {
  Flight flight;
  ASSERT_TRUE(flight.ready());
  ASSERT_TRUE(flight.take_off(1.5));
  flight.go_to({0.0, 0.0, 1.5}, hal::kPi / 2, 6s);  // facing left
  flight.ours().set_velocity({{0.5, 0.0, 0.0}, 0.0, flight.now() + 4s});
  flight.run(4s);
  EXPECT_GT(flight.body().position.y, 1.2) << "forward is +y when facing left";
  EXPECT_NEAR(flight.body().position.x, 0.0, 0.2);
  const double yaw = flight.body().yaw_rad;
  flight.ours().set_velocity({{0.0, 0.0, 0.0}, 0.5, flight.now() + 2s});
  flight.run(2s);
  EXPECT_NEAR(hal::angle_difference(flight.body().yaw_rad, yaw), 1.0, 0.3) << "positive turns left";
}

TEST(MavlinkFlight, ManagesOnALineThatLosesEveryTenthFrame) {
  mocks::SimAutopilotConfig sim;
  sim.seed = 5;
  Flight flight(sim);
  flight.sim().faults().tx.drop = 0.1;
  flight.sim().faults().rx.drop = 0.1;
  flight.sim().faults().tx.corrupt = 0.02;
  ASSERT_TRUE(flight.ready());
  ASSERT_TRUE(flight.take_off(1.5)) << flight.ours().request_detail();
  flight.go_to({2.0, 0.0, 1.5}, 0.0, 10s);
  expect_at(flight.body(), {2.0, 0.0, 1.5}, 0.0);
  const auto* const peer = flight.ours().link().sequence_stats().find(1, 1);
  ASSERT_NE(peer, nullptr);
  EXPECT_NEAR(peer->loss_fraction(), 0.12, 0.04);
}

TEST(MavlinkFlight, ARelocalisedCameraDoesNotMoveTheVehicle) {
  Flight flight;
  ASSERT_TRUE(flight.ready());
  ASSERT_TRUE(flight.take_off(1.5));
  flight.go_to({1.0, 0.0, 1.5}, 0.0, 6s);
  const hal::Vec3 before = flight.body().position;
  flight.vision_offset = {0.0, 0.6, 0.0};
  flight.run(4s);
  EXPECT_EQ(flight.filter().stats().resets, 1U);
  EXPECT_LT(hal::norm(flight.body().position - before), 0.25);
}

TEST(MavlinkFlight, HaltLandsIt) {
  Flight flight;
  ASSERT_TRUE(flight.ready());
  ASSERT_TRUE(flight.take_off(1.5));
  flight.ours().set_position({{5.0, 0.0, 1.5}, 0.0, flight.now() + 1h});
  flight.run(2s);
  flight.ours().halt();
  EXPECT_TRUE(flight.run_until(20s, [&] { return !flight.sim().armed(); }));
  EXPECT_LT(flight.body().position.z, 0.1);
  EXPECT_LT(flight.body().position.x, 3.0);
}

TEST(MavlinkFlight, TellsWhyTheAutopilotWillNotArm) {
  Flight flight;
  flight.sim().faults().refuse_arming = "PreArm: Battery below minimum arming voltage";
  ASSERT_TRUE(flight.ready());
  EXPECT_FALSE(flight.take_off(1.5));
  EXPECT_EQ(flight.ours().request_detail(), "arming refused: PreArm: Battery below minimum arming voltage");
}

TEST(MavlinkFlight, SteadyFlightAllocatesNothing) {
  Flight flight;
  ASSERT_TRUE(flight.ready());
  ASSERT_TRUE(flight.take_off(1.5));
  flight.ours().set_position({{2.0, 1.0, 1.5}, 0.5, flight.now() + 1h});
  flight.run(5s);
  const auto before = test::allocation_count();
  for (int i = 0; i < 1000; ++i) {
    flight.ours().set_position({{2.0, 1.0, 1.5}, 0.5, flight.now() + 1s});
    flight.step();
  }
  EXPECT_EQ(test::allocation_count() - before, 0U);
}

}  // namespace
}  // namespace forager::flight
