#include "tools/drive_output.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "boards/drive_campaign.hpp"
#include "tests/places.hpp"
#include "tools/cli_style.hpp"
#include "tools/cmd_drive.hpp"

namespace forager::tools {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const std::string kCourse = test::source_path("scenes/course.toml");

boards::DriveScene course() { return boards::load_drive_scene(kCourse).value(); }

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++n;
  return n;
}

TEST(DriveOutput, TheTableAndTheJsonSayTheSame) {
  boards::DriveCampaignOptions options;
  options.runs = 3;
  const auto scene = course();
  const auto summary = boards::run_campaign(scene, options);
  ASSERT_TRUE(summary);
  const auto json = nlohmann::json::parse(drive_json(scene, *summary, 1.0));
  EXPECT_EQ(json["runs"], 3);
  EXPECT_EQ(json["arrived"], summary->arrived);
  EXPECT_EQ(json["ends"]["arrived: at the goal"], summary->arrived);
  EXPECT_THAT(drive_table(scene, *summary, 1.0), HasSubstr("of 3 (100.0 %)"));
}

TEST(DriveOutput, EveryFailureIsExplained) {
  auto scene = course();
  scene.ranges[static_cast<std::size_t>(boards::DriveRange::max_thrust_n)] = {1.0, 1.0};  // hardly any push
  boards::DriveCampaignOptions options;
  options.runs = 2;
  const auto summary = boards::run_campaign(scene, options);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->arrived, 0U);
  const std::string table = drive_table(scene, *summary, 1.0);
  EXPECT_THAT(table, HasSubstr("seed 1"));
  EXPECT_THAT(table, HasSubstr("no_motion"));
  EXPECT_EQ(nlohmann::json::parse(drive_json(scene, *summary, 1.0))["failures"].size(), 2U);
}

TEST(DriveOutput, ThePageIsSelfContainedAndShowsEveryStep) {
  auto scene = course();
  scene.title = "a <b> & \"c\"";
  boards::DriveRunOptions options;
  options.keep_track = true;
  const auto run = boards::run_drive(scene, options);
  ASSERT_TRUE(run);
  const std::string page = drive_page(scene, *run);
  EXPECT_THAT(page, StartsWith("<!DOCTYPE html>"));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("<b>")));
  EXPECT_EQ(count(page, "class=\"step\""), run->steps);
  EXPECT_EQ(count(page, "class=\"box\""), scene.obstacles.size());
  EXPECT_GT(run->track.size(), 100U);
}

TEST(DriveCommand, FailsItsCheckWhenTooFewArrive) {
  DriveCommand command;
  command.scene = kCourse;
  command.quiet = true;
  EXPECT_EQ(run_drive_command(command), kExitDone);
  command.least_arrived = 1.1;  // more than all
  EXPECT_EQ(run_drive_command(command), kExitCheckFailed);
  command.scene = "no/such/scene.toml";
  EXPECT_EQ(run_drive_command(command), kExitUnavailable);
}

}  // namespace
}  // namespace forager::tools
