// What the missions come to, flown end to end through every wire byte of reader and autopilot.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "tests/boards/flown_mission.hpp"

namespace forager::boards {
namespace {

using flight::EndReason;

class StigmergicScene : public testing::TestWithParam<const char*> {};

TEST_P(StigmergicScene, FindsNearlyEveryTagAndComesDownByItself) {
  const auto missions = fly_seeds(published_scene(GetParam()));
  // Stated for the seeds 1 to 20; fewer are flown where a mission takes many times as long.
  if (missions.size() >= 20) {
    EXPECT_GE(median_coverage(missions), 0.96);
  }
  std::size_t unlucky = 0;
  for (const FlownMission& mission : missions) {
    SCOPED_TRACE(mission.summary.seed);
    EXPECT_EQ(mission.summary.end, EndReason::no_new_tags) << mission.summary.detail;
    EXPECT_EQ(mission.summary.crashes, 0U);
    EXPECT_EQ(mission.summary.reader_losses, 0U);
    // An unlucky run may end before it hears of a row of boxes beyond a corner, not in the first aisle.
    EXPECT_GE(mission.coverage(), 0.5);
    if (mission.coverage() < 0.9) ++unlucky;
    EXPECT_LE(mission.summary.tags_read, mission.summary.tags_present.value_or(0));
  }
  EXPECT_LE(unlucky, missions.size() / 5);
}

INSTANTIATE_TEST_SUITE_P(Scenes, StigmergicScene,
                         testing::Values("1C", "2C", "3C", "4A", "4B", "4C", "5A", "5B"),
                         [](const auto& scene) { return std::string("S") + scene.param; });

// The T's arm without tags: beyond the end of the stem, on the side where nothing is heard.
struct EmptyArm {
  static constexpr double kBeyondX = 7.02;
  static constexpr double kEntranceY = -1.75;
  static double depth_m(const hal::Vec3& p) { return p.x > kBeyondX ? kEntranceY - p.y : -1.0; }
};

class TShapedScene : public testing::TestWithParam<const char*> {};

TEST_P(TShapedScene, TheEmptyArmIsTriedTwoStepsDeepAtMost) {
  const Scene scene = published_scene(GetParam());
  const double two_steps = 2.0 * scene.mission.step_m;
  std::size_t unlucky = 0;
  std::size_t decisions_inside = 0;
  std::size_t decisions = 0;
  for (const FlownMission& mission : fly_seeds(scene)) {
    SCOPED_TRACE(mission.summary.seed);
    for (const auto& point : mission.path)
      ASSERT_LE(EmptyArm::depth_m(point.pose_world.position), two_steps) << hal::to_seconds(point.at) << " s";
    for (const flight::Decision& decision : mission.decisions)
      if (EmptyArm::depth_m(decision.from.position) > 0.0) ++decisions_inside;
    decisions += mission.decisions.size();
    // The arm with tags is flown to its boxes.
    const bool reached = std::any_of(mission.path.begin(), mission.path.end(), [](const auto& point) {
      return point.pose_world.position.x > EmptyArm::kBeyondX && point.pose_world.position.y > 1.0;
    });
    if (!reached) ++unlucky;
  }
  EXPECT_LE(unlucky, kSeeds / 5);  // ended before it heard of them
  RecordProperty("decisions_in_empty_arm", static_cast<int>(decisions_inside));
  EXPECT_LT(static_cast<double>(decisions_inside), 0.1 * static_cast<double>(decisions));
}

INSTANTIATE_TEST_SUITE_P(Scenes, TShapedScene, testing::Values("4A", "4B", "4C", "5A"),
                         [](const auto& scene) { return std::string("S") + scene.param; });

class Scenario : public testing::TestWithParam<const char*> {};

TEST_P(Scenario, HoveringAndAFixedPathReadClearlyLessThanFollowingTheTags) {
  const std::string number = GetParam();
  const auto still = fly_seeds(published_scene(number + "A"));
  const auto fixed = fly_seeds(published_scene(number + "B"));
  const double followed = median_coverage(fly_seeds(published_scene(number + "C")));
  EXPECT_LE(median_coverage(still), 0.6);
  EXPECT_LE(median_coverage(still), followed - 0.1);
  EXPECT_LE(median_coverage(fixed), followed - 0.1);
  EXPECT_LT(median_coverage(still), median_coverage(fixed));
  for (const FlownMission& mission : still) {
    EXPECT_EQ(mission.summary.end, EndReason::time_limit) << mission.summary.detail;
    EXPECT_LT(mission.summary.path_m, 1.0);
    EXPECT_EQ(mission.summary.crashes, 0U);
  }
  for (const FlownMission& mission : fixed) {
    EXPECT_EQ(mission.summary.end, EndReason::path_complete) << mission.summary.detail;
    EXPECT_EQ(mission.summary.crashes, 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Scenario, testing::Values("1", "2", "3"),
                         [](const auto& scene) { return std::string("S") + scene.param; });

class FixedPath : public testing::TestWithParam<const char*> {};

TEST_P(FixedPath, IsFlownToItsLastWaypoint) {
  const Scene scene = published_scene(GetParam());
  const hal::Vec3 goal = scene.mission.waypoints.back();
  for (const FlownMission& mission : fly_seeds(scene)) {
    SCOPED_TRACE(mission.summary.seed);
    EXPECT_EQ(mission.summary.end, EndReason::path_complete) << mission.summary.detail;
    EXPECT_EQ(mission.summary.crashes, 0U);
    const hal::Vec3 last = mission.path.back().pose_world.position;
    EXPECT_NEAR(last.x, goal.x, 0.3);
    EXPECT_NEAR(last.y, goal.y, 0.3);
    EXPECT_GT(mission.coverage(), 0.4);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, FixedPath, testing::Values("ch4-1", "ch4-2", "ch4-3"),
                         [](const auto& scene) { return "Chapter4Number" + std::string(1, scene.param[4]); });

// The other policies, in an aisle between shelves that they were not written for.
class OtherPolicy : public testing::TestWithParam<PolicyKind> {};

TEST_P(OtherPolicy, EndsInOrderAndTouchesNothing) {
  Scene scene = published_scene("3C");
  scene.mission.time_limit = std::chrono::minutes(5);
  const auto changed = change_policy(scene, GetParam());
  ASSERT_TRUE(changed) << describe(changed.error());
  for (const FlownMission& mission : fly_seeds(scene)) {
    SCOPED_TRACE(mission.summary.seed);
    EXPECT_TRUE(mission.summary.end == EndReason::no_new_tags || mission.summary.end == EndReason::time_limit)
        << to_string(mission.summary.end) << " " << mission.summary.detail;
    EXPECT_EQ(mission.summary.crashes, 0U);
    EXPECT_GT(mission.summary.flight_time_s, 10.0);
    EXPECT_GT(mission.summary.tags_read, 100U);
  }
}

INSTANTIATE_TEST_SUITE_P(Policies, OtherPolicy,
                         testing::Values(PolicyKind::stop_and_rotate, PolicyKind::random_walk),
                         [](const auto& policy) { return std::string(to_string(policy.param)); });

}  // namespace
}  // namespace forager::boards
