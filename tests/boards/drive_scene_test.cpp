#include "boards/drive_scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "boards/drive_path.hpp"
#include "boards/drive_run.hpp"
#include "hal/units.hpp"
#include "tests/places.hpp"

namespace forager::boards {
namespace {

using testing::HasSubstr;

const std::string kCourse = test::source_path("scenes/course.toml");

hal::Result<DriveScene> read(const std::string& text) {
  const auto root = parse_config(text, "test.toml");
  if (!root) return hal::fail(root.error());
  return read_drive_scene(*root, "test.toml");
}

TEST(DriveScene, TheCourseKeepsItsBodyClearOfEveryObstacle) {
  const auto scene = load_drive_scene(kCourse);
  ASSERT_TRUE(scene) << hal::describe(scene.error());
  ASSERT_GE(scene->obstacles.size(), 2U);
  for (const auto& pose : scene->path)
    for (const DriveObstacle& box : scene->obstacles) {
      const double dx = std::max({box.min_x - pose.x_m, pose.x_m - box.max_x, 0.0});
      const double dy = std::max({box.min_y - pose.y_m, pose.y_m - box.max_y, 0.0});
      EXPECT_GT(std::hypot(dx, dy), scene->body_half_width_m + scene->corridor_half_width_m);
    }
}

TEST(DriveScene, StepsLieOnThePathAndEndAtTheGoal) {
  const auto scene = load_drive_scene(kCourse);
  ASSERT_TRUE(scene);
  const auto mission = drive_mission(*scene);
  ASSERT_TRUE(mission);
  EXPECT_NEAR(mission->steps.back().x_m, 7.2, 1e-9);
  EXPECT_NEAR(mission->steps.back().y_m, 0.0, 1e-9);
  for (const auto& pose : scene->path)
    EXPECT_LE(mission->corridor.distance_m({pose.x_m, pose.y_m, 0.0}), scene->steps.tolerance_m + 1e-9);
}

TEST(DriveScene, RoundsCornersAndKeepsItsSpacing) {
  const DrivePoint corners[] = {{0.0, 0.0}, {2.0, 0.0}, {2.0, 2.0}};
  const auto path = rounded_path(corners, 0.5, 0.025);
  double cut = 1.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    EXPECT_LE(std::hypot(path[i].x_m - path[i - 1].x_m, path[i].y_m - path[i - 1].y_m), 0.0251);
    cut = std::min(cut, std::hypot(path[i].x_m - 2.0, path[i].y_m));
  }
  EXPECT_GT(cut, 0.1) << "the corner itself is not driven through";
  EXPECT_NEAR(path.front().yaw_rad, 0.0, 1e-9);
  EXPECT_NEAR(path.back().yaw_rad, 0.5 * hal::kPi, 1e-9);
  EXPECT_NEAR(path.back().y_m, 2.0, 1e-9);
}

TEST(DriveScene, SaysWhereAMistakeIs) {
  const struct {
    const char* text;
    const char* says;
  } cases[] = {
      {"[drive]\nname = \"x\"\n", "path"},
      {"[drive]\nname = \"x\"\npath = [[0.0, 0.0]]\n", "does not lead anywhere"},
      {"[drive]\nname = \"x\"\npath = [[0.0, 0.0], [1e9, 0.0]]\n", "at most 1000 m"},
      {"[drive]\nname = \"x\"\npath = [[0.0, 0.0], [2.0, 0.0]]\nspeed = 3\n", "speed"},
      {"[drive]\nname = \"x\"\npath = [[0.0, 0.0], [2.0, 0.0]]\n[ranges]\nfriction = [0.9, 0.1]\n",
       "friction"},
      {"[drive]\nname = \"x\"\npath = [[0.0, 0.0], [2.0, 0.0]]\n[control]\nthrust = 7\n", "thrust"},
      {"[drive]\nname = \"x\"\npath = [[0.0, 0.0], [2.0, 0.0]]\n[[obstacles]]\nmin = [1.0, 1.0]\nmax = [0.0, "
       "2.0]\n",
       "max"},
  };
  for (const auto& c : cases) {
    const auto scene = read(c.text);
    ASSERT_FALSE(scene) << c.text;
    EXPECT_THAT(hal::describe(scene.error()), HasSubstr(c.says));
    EXPECT_THAT(hal::describe(scene.error()), HasSubstr("test.toml"));
  }
}

}  // namespace
}  // namespace forager::boards
