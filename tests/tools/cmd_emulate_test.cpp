#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

#include "tests/places.hpp"
#include "tests/tools/socket_rig.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;

std::string scene() { return test::source_path("scenes/4A.toml"); }

std::vector<std::string> anywhere(const std::string& device) {
  std::vector<std::string> arguments{"emulate", device, scene()};
  if (device == "reader")
    for (const char* more : {"--rest-port", "0", "--stream-port", "0", "--truth", "127.0.0.1:0"})
      arguments.emplace_back(more);
  else
    for (const char* more : {"--listen", "127.0.0.1:0"}) arguments.emplace_back(more);
  return arguments;
}

long lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

TEST(EmulateCommand, SaysWhereItCanBeReachedAndEndsWell) {
  for (const char* device : {"reader", "autopilot"})
    for (const int number : {SIGINT, SIGTERM}) {
      Program program(anywhere(device));
      ASSERT_TRUE(program.wait_for_out("127.0.0.1:", kPatience)) << program.finish().err;
      program.send_signal(number);
      const ProgramResult result = program.finish();
      EXPECT_EQ(result.exit_code, 0) << device << result.err;
      EXPECT_EQ(lines(result.out), 1) << result.out;
      EXPECT_NE(result.err.find(number == SIGINT ? "SIGINT" : "SIGTERM"), std::string::npos) << result.err;
    }
}

TEST(EmulateCommand, EndsByItselfWhenItsTimeIsOver) {
  std::vector<std::string> arguments = anywhere("autopilot");
  for (const char* more : {"--for", "0.2", "--json"}) arguments.emplace_back(more);
  const ProgramResult result = run_program(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GT(last_event(result.out, "listening")["endpoints"]["mavlink"]["port"], 0) << result.out;
  EXPECT_EQ(last_event(result.out, "ended")["device"], "autopilot") << result.out;
}

TEST(EmulateCommand, NamesThePortThatIsInUse) {
  SocketRig rig;
  rig.start_reader();
  rig.start_autopilot();
  const auto second = [](const std::vector<std::string>& arguments) {
    const ProgramResult result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 1) << result.out;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(lines(result.err), 1) << result.err;
    return result.err;
  };
  const std::string rest = std::to_string(rig.rest_port);
  const std::string mavlink = rig.host + ":" + std::to_string(rig.mavlink_port);
  EXPECT_NE(second({"emulate", "reader", scene(), "--host", rig.host, "--rest-port", rest}).find(rest),
            std::string::npos);
  EXPECT_NE(second({"emulate", "autopilot", scene(), "--listen", mavlink}).find(mavlink), std::string::npos);
}

TEST(EmulateCommand, RefusesWhatCannotWork) {
  struct Case {
    std::vector<std::string> arguments;
    int exit_code;
    const char* says;
  };
  const std::vector<Case> cases{
      {{"emulate"}, 2, "a command is missing"},
      {{"emulate", "toaster", scene()}, 2, "toaster"},
      {{"emulate", "reader", "no/such.toml"}, 3, "no/such.toml"},
      {{"emulate", "autopilot", scene(), "--listen", "nowhere"}, 2, "HOST:PORT"},
      {{"emulate", "autopilot", scene(), "--truth", "127.0.0.1:0"}, 2, "HOST:PORT"},
      {{"emulate", "reader", scene(), "--user", "robot"}, 2, "--password-env"},
      {{"emulate", "reader", scene(), "--user", "robot", "--password-env", "NOT_SET_ANYWHERE"},
       3,
       "NOT_SET_ANYWHERE"},
  };
  for (const Case& it : cases) {
    const ProgramResult result = run_program(it.arguments);
    EXPECT_EQ(result.exit_code, it.exit_code) << result.err;
    EXPECT_NE(result.err.find(it.says), std::string::npos) << result.err;
  }
}

}  // namespace
}  // namespace forager::tools
