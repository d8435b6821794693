// Whole missions over real sockets: the mission, the emulated reader and the emulated autopilot are programs
// of their own that can be killed one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>

#include "tests/tools/socket_rig.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;

class SocketMission : public SocketTest {};

constexpr int kTags = 40;

int tags_read(const Json& summary) { return summary.value("tags_read", -1); }

// Well under way: something was found, more is to come.
bool found_some(const ProgramResult& so_far) { return tags_decided_on(so_far.out) >= 8; }

// Two hundred seeds in process read 37 to 40 of the 40 tags; what differs over sockets is when each byte
// arrives, so every draw of the air falls differently. Five tags are more than twice the widest difference
// seen.
TEST_F(SocketMission, FindsWhatTheSameMissionInOneProgramFinds) {
  SocketRig rig;
  rig.start_reader();
  rig.start_autopilot();
  const ProgramResult flown = rig.start_mission().finish();
  const Json over_sockets = last_event(flown.out, "summary");
  const Json in_process = last_event(rig.fly_in_process().out, "summary");
  EXPECT_EQ(flown.exit_code, 0) << flown.err;
  EXPECT_EQ(over_sockets["end_reason"], "no_new_tags") << over_sockets;
  EXPECT_NEAR(tags_read(over_sockets), tags_read(in_process), 5) << over_sockets;
  EXPECT_GE(tags_read(in_process), kTags - 2) << in_process;
  EXPECT_EQ(over_sockets["reader_losses"], 0);
  EXPECT_GT(over_sockets["path_m"], 1.0);
  EXPECT_EQ(rig.inventory().size(), static_cast<std::size_t>(tags_read(over_sockets)));
  EXPECT_EQ(rig.inventory_reads(), over_sockets["reads"]);
}

TEST_F(SocketMission, GoesOnWhenTheReaderComesBack) {
  SocketRig rig({.links = "reader_allowance_s = 300.0"});
  rig.start_reader();
  rig.start_autopilot();
  Program& mission = rig.start_mission();
  ASSERT_TRUE(mission.wait_until(found_some, kPatience)) << mission.so_far().out;
  rig.reader().send_signal(SIGKILL);
  rig.reader().finish();
  const auto before = rig.inventory();
  ASSERT_GE(before.size(), 4u);
  ASSERT_TRUE(mission.wait_for_out("link lost", kPatience));
  rig.start_reader();

  const ProgramResult flown = mission.finish();
  const Json summary = last_event(flown.out, "summary");
  EXPECT_EQ(flown.exit_code, 0) << flown.err;
  EXPECT_EQ(summary["end_reason"], "no_new_tags") << summary;
  EXPECT_GE(summary["reader_losses"], 1);
  EXPECT_GE(tags_read(summary), kTags - 5) << summary;
  const auto after = rig.inventory();
  EXPECT_TRUE(std::ranges::includes(after, before)) << "tags read before the loss are gone";
  EXPECT_EQ(rig.inventory_reads(), summary["reads"]);
}

TEST_F(SocketMission, LandsWithItsInventoryWhenTheReaderStaysAway) {
  SocketRig rig({.links = "reader_allowance_s = 5.0"});
  rig.start_reader();
  rig.start_autopilot();
  Program& mission = rig.start_mission();
  ASSERT_TRUE(mission.wait_until(found_some, kPatience)) << mission.so_far().out;
  rig.reader().send_signal(SIGKILL);
  rig.reader().finish();
  const auto before = rig.inventory();

  const ProgramResult flown = mission.finish();
  const Json summary = last_event(flown.out, "summary");
  EXPECT_EQ(flown.exit_code, 1) << flown.err;
  EXPECT_EQ(summary["end_reason"], "reader_lost") << summary;
  EXPECT_TRUE(rig.autopilot().wait_for_out("Disarming motors", kPatience)) << "still in the air";
  const auto after = rig.inventory();
  EXPECT_GE(after.size(), 4u);
  EXPECT_TRUE(std::ranges::includes(after, before));
  EXPECT_GE(after.size(), last_event(flown.out, "progress")["tags"]);
  EXPECT_EQ(after.size(), static_cast<std::size_t>(tags_read(summary)));
  EXPECT_EQ(rig.inventory_reads(), summary["reads"]);
}

ProgramOptions with_password(const std::string& password) {
  ProgramOptions options;
  options.environment = {{"AISLE_PASSWORD", password}};
  return options;
}

const std::vector<std::string> kLogin{"--user", "robot", "--password-env", "AISLE_PASSWORD"};
constexpr const char* kBoardLogin = "user = \"robot\"\npassword_env = \"AISLE_PASSWORD\"";

TEST_F(SocketMission, LogsInToTheReader) {
  SocketRig rig({.mission = "time_limit_s = 10.0", .login = kBoardLogin});
  rig.start_reader(kLogin, with_password("keep out"));
  rig.start_autopilot();
  const ProgramResult flown = rig.start_mission(with_password("keep out")).finish();
  const Json summary = last_event(flown.out, "summary");
  EXPECT_EQ(flown.exit_code, 0) << flown.err;
  EXPECT_EQ(summary["end_reason"], "time_limit") << summary;
  EXPECT_GE(tags_read(summary), 4) << summary;
}

TEST_F(SocketMission, StaysOnTheGroundWithTheWrongPassword) {
  SocketRig rig({.login = kBoardLogin});
  rig.start_reader(kLogin, with_password("keep out"));
  rig.start_autopilot();
  const ProgramResult flown = rig.start_mission(with_password("let me in")).finish();
  const Json summary = last_event(flown.out, "summary");
  EXPECT_EQ(flown.exit_code, 1);
  EXPECT_EQ(summary["end_reason"], "reader_lost") << summary;
  EXPECT_NE(summary["detail"].get<std::string>().find("password"), std::string::npos) << summary;
  EXPECT_EQ(summary["path_m"], 0.0);
  EXPECT_EQ(flown.out.find("let me in"), std::string::npos) << "the password is in the output";
  EXPECT_FALSE(rig.autopilot_armed());
}

TEST_F(SocketMission, SaysWhyTheAutopilotDoesNotArm) {
  SocketRig rig;
  rig.start_reader();
  rig.start_autopilot({"--refuse-arming", "Compass not calibrated"});
  const ProgramResult flown = rig.start_mission().finish();
  const Json summary = last_event(flown.out, "summary");
  EXPECT_EQ(flown.exit_code, 4) << flown.err;
  EXPECT_EQ(summary["end_reason"], "refused") << summary;
  EXPECT_NE(summary["detail"].get<std::string>().find("Compass not calibrated"), std::string::npos)
      << summary;
  EXPECT_EQ(summary["path_m"], 0.0);
  EXPECT_FALSE(rig.autopilot_armed());
}

TEST_F(SocketMission, EndsWhenTheAutopilotIsGone) {
  SocketRig rig({.links = "autopilot_allowance_s = 5.0"});
  rig.start_reader();
  rig.start_autopilot();
  Program& mission = rig.start_mission();
  ASSERT_TRUE(mission.wait_until(found_some, kPatience)) << mission.so_far().out;
  rig.autopilot().send_signal(SIGKILL);
  rig.autopilot().finish();
  const ProgramResult flown = mission.finish();
  const Json summary = last_event(flown.out, "summary");
  EXPECT_EQ(flown.exit_code, 1) << flown.err;
  EXPECT_EQ(summary["end_reason"], "autopilot_lost") << summary;
  EXPECT_EQ(rig.inventory_reads(), summary["reads"]);
  rig.reader().send_signal(SIGTERM);
  EXPECT_NE(rig.reader().finish().out.find("/stop"), std::string::npos) << "the reader still radiates";
}

}  // namespace
}  // namespace forager::tools
