// Whole drives on the emulated vehicle, judged by where it truly was.
#include "boards/drive_run.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "boards/drive_campaign.hpp"
#include "boards/drive_plant.hpp"
#include "hal/units.hpp"
#include "mocks/text_journal.hpp"
#include "tests/places.hpp"

namespace forager::boards {
namespace {

using flight::DriveEnd;

const DriveScene& course() {
  static const DriveScene scene = load_drive_scene(test::source_path("scenes/course.toml")).value();
  return scene;
}

DriveResult drive(DriveRunOptions options) {
  auto result = run_drive(course(), options);
  EXPECT_TRUE(result) << hal::describe(result.error());
  return result.value_or(DriveResult{});
}

TEST(DriveRun, ArrivesOverTheRangesOfTheScene) {
  DriveCampaignOptions options;
  options.runs = 25;
  const auto summary = run_campaign(course(), options);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->arrived, summary->runs);
  EXPECT_EQ(summary->out_without_stop, 0U);
  EXPECT_EQ(summary->contacts, 0U);
  EXPECT_LT(summary->position_m.worst, 0.15);
  EXPECT_LT(summary->heading_deg.worst, 10.0);
}

TEST(DriveRun, ArrivesThroughAllBytes) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const DriveResult run = drive({.seed = seed, .wire = true});
    EXPECT_TRUE(run.arrived(course())) << to_string(run.end) << ": " << run.detail;
  }
}

TEST(DriveRun, EqualSeedsGiveEqualRunsToTheByte) {
  const auto digest = [](std::uint64_t seed) {
    mocks::TextJournal journal({.keep = false, .max_hex_bytes = 0, .sink = {}});
    const DriveResult run = drive({.seed = seed, .wire = true, .journal = &journal});
    return std::pair(journal.hash(), run.position_error_m);
  };
  EXPECT_EQ(digest(3), digest(3));
  EXPECT_NE(digest(3).first, digest(4).first);
}

TEST(DriveRun, BrakesAreLockedBeforeTheFirstCommandAndAfterTheEnd) {
  mocks::TextJournal journal;
  const DriveResult run = drive({.seed = 1, .wire = true, .journal = &journal});
  EXPECT_TRUE(run.stands);
  const auto engaged = journal.find("brakes engaged");
  const auto arming = journal.find("phase arming");
  const auto driving = journal.find("phase driving");
  ASSERT_NE(engaged, std::string::npos);
  EXPECT_LT(engaged, arming);
  EXPECT_LT(arming, driving);
  EXPECT_NE(journal.find("Disarming motors", driving), std::string::npos);
}

// Each kind of fault, over a few seeds: safe within the bound of its detection, and standing in the end.
class DriveFaults : public testing::TestWithParam<std::size_t> {};

TEST_P(DriveFaults, EndBrakedWithoutThrustInTime) {
  const auto fault = static_cast<DriveFault>(GetParam());
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const DriveResult run =
        drive({.seed = seed, .fault = fault, .fault_s = 4.0 + 5.0 * static_cast<double>(seed)});
    ASSERT_TRUE(run.struck_s) << to_string(fault) << " seed " << seed;
    EXPECT_TRUE(run.stands) << to_string(fault) << " seed " << seed;
    if (!run.detected_s) {
      EXPECT_TRUE(run.arrived(course()))
          << to_string(fault) << " seed " << seed << ": not noticed, and it mattered";
      continue;
    }
    ASSERT_TRUE(run.reaction_s()) << to_string(fault) << " seed " << seed;
    EXPECT_LE(*run.reaction_s(), kDriveReactionBound_s) << to_string(fault) << " seed " << seed;
    EXPECT_LT(run.turned_after_rad, hal::kPi) << to_string(fault) << " seed " << seed << ": never a spin";
  }
}

INSTANTIATE_TEST_SUITE_P(AllKinds, DriveFaults, testing::Range<std::size_t>(1, kDriveFaults),
                         [](const auto& kind) {
                           return std::string(to_string(static_cast<DriveFault>(kind.param)));
                         });

TEST(DriveFaultsOverTheWire, EndTheSameWay) {
  for (const DriveFault fault : {DriveFault::link_lost, DriveFault::stop_link, DriveFault::process_killed}) {
    const DriveResult run = drive({.seed = 2, .fault = fault, .fault_s = 12.0, .wire = true});
    ASSERT_TRUE(run.detected_s) << to_string(fault);
    ASSERT_TRUE(run.reaction_s()) << to_string(fault);
    EXPECT_LE(*run.reaction_s(), kDriveReactionBound_s) << to_string(fault);
    EXPECT_TRUE(run.stands) << to_string(fault);
  }
}

TEST(DriveRun, NamesTheReasonItStoppedFor) {
  const auto end = [](DriveFault fault) { return drive({.seed = 1, .fault = fault, .fault_s = 8.0}).end; };
  EXPECT_EQ(end(DriveFault::stop_button), DriveEnd::emergency_stop);
  EXPECT_EQ(end(DriveFault::stop_link), DriveEnd::emergency_stop);
  EXPECT_EQ(end(DriveFault::pose_silent), DriveEnd::pose_lost);
  EXPECT_EQ(end(DriveFault::link_lost), DriveEnd::autopilot_lost);
  EXPECT_EQ(end(DriveFault::watch_lost), DriveEnd::deadman);
  EXPECT_EQ(end(DriveFault::motors_dead), DriveEnd::no_motion);
}

TEST(DriveRun, SpeedByPitchArrivesToo) {
  DriveScene scene = course();
  scene.drive.steer.speed_by_pitch = true;
  DriveCampaignOptions options;
  options.runs = 10;
  const auto summary = run_campaign(scene, options);
  ASSERT_TRUE(summary);
  EXPECT_GE(summary->arrived, 9U);
  EXPECT_EQ(summary->out_without_stop, 0U);
}

TEST(DrivePlant, EverySeedDrawsWithinTheRanges) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const DrivePlantDraw draw = draw_plant(course(), seed);
    const DriveSpan& friction = course().range(DriveRange::friction);
    EXPECT_GE(draw.vehicle.friction, friction.low);
    EXPECT_LE(draw.vehicle.friction, friction.high);
    const DriveSpan& lag = course().range(DriveRange::servo_lag_s);
    EXPECT_GE(draw.vehicle.servo_lag_s, lag.low);
    EXPECT_LE(draw.vehicle.servo_lag_s, lag.high);
  }
  EXPECT_NE(draw_plant(course(), 1).vehicle.mass_kg, draw_plant(course(), 2).vehicle.mass_kg);
}

}  // namespace
}  // namespace forager::boards
