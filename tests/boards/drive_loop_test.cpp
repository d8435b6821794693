// What the drive loop does when others act: pilots, doors, buttons, and whoever forgets to feed it.
#include "flight/drive_loop.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "boards/drive_direct.hpp"
#include "boards/drive_run.hpp"
#include "mocks/fake_depth_source.hpp"
#include "mocks/fake_digital_in.hpp"
#include "mocks/sim_pose_source.hpp"
#include "mocks/text_journal.hpp"
#include "tests/places.hpp"

namespace forager::boards {
namespace {

using namespace std::chrono_literals;
using flight::DriveEnd;
using flight::DrivePhase;
using hal::Instant;

const hal::DepthCameraModel kCamera{
    .columns = 64, .rows = 48, .fx_px = 34.0, .fy_px = 43.0, .cx_px = 32.0, .cy_px = 24.0};

struct Bench {
  explicit Bench(bool with_depth = false) {
    loop.emplace(scene.drive,
                 flight::DriveDevices{autopilot, camera, left, right, journal, nullptr, &button,
                                      with_depth ? &depth : nullptr},
                 drive_mission(scene).value(), now);
  }
  void tick() {
    autopilot.run(now);
    vehicle.push(autopilot.thrust(), autopilot.pitch_rad());
    vehicle.press(left.demand(), right.demand());
    vehicle.update(now);
    if (feeds) loop->feed(now);
    loop->go(now + 100ms);
    loop->update(now);
    now += 10ms;
  }
  void run(hal::Duration length) {
    for (const Instant end = now + length; now < end; tick()) {
    }
  }
  void set_off() {
    while (vehicle.speed_m_s() < 0.25 && now < Instant{60s}) tick();
    ASSERT_GE(vehicle.speed_m_s(), 0.25);
  }
  [[nodiscard]] bool stopped() const {
    return left.demand() == 1.0 && right.demand() == 1.0 && autopilot.thrust() == 0.0;
  }

  DriveScene scene = load_drive_scene(test::source_path("scenes/course.toml")).value();
  DrivePlantDraw draw = draw_plant(scene, 3);
  mocks::RollingVehicle vehicle{draw.vehicle, scene.start};
  mocks::SimPoseSource camera{vehicle, mocks::SimPoseOptions{}, 5};
  mocks::FakeDepthSource depth;
  DirectAutopilot autopilot{vehicle, scene, draw, 6};
  DirectBrake left{"left"};
  DirectBrake right{"right"};
  mocks::FakeDigitalIn button{"stop"};
  mocks::TextJournal journal;
  Instant now{};
  bool feeds = true;
  std::optional<flight::DriveLoop> loop;
};

TEST(DriveLoop, NeitherArmsNorMovesUnfed) {
  Bench bench;
  bench.feeds = false;
  bench.run(5s);
  EXPECT_EQ(bench.loop->status().phase, DrivePhase::waiting);
  EXPECT_FALSE(bench.vehicle.state().armed);
  EXPECT_TRUE(bench.stopped());
}

TEST(DriveLoop, KeepsItsHandsOffAVehicleThatIsArmedAlready) {
  Bench bench;
  bench.autopilot.arm_by_hand();
  bench.run(1s);
  EXPECT_EQ(bench.loop->status().end, DriveEnd::pilot);
  EXPECT_TRUE(bench.vehicle.state().armed) << "not ours to disarm";
}

TEST(DriveLoop, APilotHasTheVehicleAtOnceAndItIsBrakedNotDisarmed) {
  Bench bench;
  bench.set_off();
  bench.autopilot.take_over();
  bench.run(500ms);
  EXPECT_EQ(bench.loop->status().end, DriveEnd::pilot);
  EXPECT_EQ(bench.left.demand(), 1.0);
  EXPECT_EQ(bench.right.demand(), 1.0);
  EXPECT_TRUE(bench.vehicle.state().armed);
}

TEST(DriveLoop, AButtonThatCannotBeReadIsPressed) {
  Bench bench;
  bench.set_off();
  bench.button.disconnect();
  bench.tick();
  EXPECT_EQ(bench.loop->status().end, DriveEnd::emergency_stop);
  bench.tick();
  EXPECT_TRUE(bench.stopped());
}

TEST(DriveLoop, AButtonLetGoAgainDoesNotSetItOff) {
  Bench bench;
  bench.set_off();
  bench.button.drive(true, bench.now);
  bench.tick();
  bench.button.drive(false, bench.now);
  bench.run(5s);
  EXPECT_EQ(bench.loop->status().end, DriveEnd::emergency_stop);
  EXPECT_FALSE(bench.vehicle.state().armed);
  EXPECT_LT(std::abs(bench.vehicle.speed_m_s()), 1e-9);
}

TEST(DriveLoop, HaltLocksBothBrakesBeforeTheNextUpdate) {
  Bench bench;
  bench.set_off();
  bench.loop->halt();
  EXPECT_EQ(bench.left.demand(), 1.0);
  EXPECT_EQ(bench.right.demand(), 1.0);
  bench.run(3s);
  EXPECT_EQ(bench.loop->status().end, DriveEnd::halted);
  EXPECT_FALSE(bench.vehicle.state().armed);
}

TEST(DriveLoop, StopsForWhatStandsInTheWayAndGoesOnWhenItHasGone) {
  Bench bench(true);
  const auto look = [&](float metres, hal::Duration length) {
    for (const Instant end = bench.now + length; bench.now < end; bench.tick())
      bench.depth.show_wall(bench.now, kCamera, metres);
  };
  while (bench.vehicle.speed_m_s() < 0.25 && bench.now < Instant{60s}) look(7.0F, 10ms);
  ASSERT_GE(bench.vehicle.speed_m_s(), 0.25);
  look(0.8F, 2s);
  EXPECT_LT(std::abs(bench.vehicle.speed_m_s()), 1e-9);
  EXPECT_TRUE(bench.stopped());
  EXPECT_EQ(bench.loop->status().phase, DrivePhase::driving) << "it waits";
  const Instant gone = bench.now;
  while (bench.vehicle.speed_m_s() < 0.2 && bench.now < gone + 10s) look(7.0F, 10ms);
  EXPECT_GE(bench.vehicle.speed_m_s(), 0.2);
  EXPECT_EQ(bench.journal.count("way_ahead lost"), 1U);
}

TEST(DriveLoop, ACameraThatFallsSilentStopsIt) {
  Bench bench(true);
  while (bench.vehicle.speed_m_s() < 0.25 && bench.now < Instant{60s}) {
    bench.depth.show_wall(bench.now, kCamera, 7.0F);
    bench.tick();
  }
  ASSERT_GE(bench.vehicle.speed_m_s(), 0.25);
  bench.run(2s);
  EXPECT_TRUE(bench.stopped()) << "blind is blocked";
}

}  // namespace
}  // namespace forager::boards
