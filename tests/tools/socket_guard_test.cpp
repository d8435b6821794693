// A mission that is killed must not leave its reader radiating.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <string>

#include "tests/tools/program.hpp"
#include "tests/tools/socket_rig.hpp"

namespace forager::tools {
namespace {

using testing::HasSubstr;

class SocketGuard : public SocketTest {};

std::string reader_state(const ProgramResult& so_far) {
  const Json status = last_event(so_far.out, "status");
  return status.is_null() ? std::string() : status.value("text", std::string());
}

TEST_F(SocketGuard, StopsTheReaderOfAMissionThatWasKilled) {
  SocketRig rig;
  rig.start_reader();
  rig.start_autopilot();
  Program& mission = rig.start_mission();
  ASSERT_TRUE(
      mission.wait_until([](const ProgramResult& it) { return tags_decided_on(it.out) >= 4; }, kPatience))
      << mission.so_far().out;
  mission.send_signal(SIGKILL);
  const ProgramResult killed = mission.finish();
  EXPECT_EQ(killed.signal, SIGKILL);
  EXPECT_THAT(killed.err, HasSubstr("forager guard: forager run died"));
  EXPECT_THAT(killed.err, HasSubstr("forager guard: reader: safe"));
  EXPECT_TRUE(rig.reader().wait_until(
      [](const ProgramResult& it) { return reader_state(it).starts_with("stopped"); }, kPatience))
      << reader_state(rig.reader().so_far());
}

}  // namespace
}  // namespace forager::tools
