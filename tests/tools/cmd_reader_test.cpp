// `forager reader` from outside: an emulated reader in the program, one behind real sockets, and none at all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <string>
#include <vector>

#include "tests/scratch_folder.hpp"
#include "tests/tools/bench_command.hpp"
#include "tests/tools/fake_machine.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/socket_rig.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

Json end_of(const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"reader", "watch", "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramResult result = run_program(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return last_event(result.out, "end");
}

TEST(CmdReader, InfoSaysWhatItIsAndHowItIsSetUp) {
  const ProgramResult text = run_program({"reader", "info"});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_EQ(text.err, "");
  EXPECT_THAT(text.out, HasSubstr("reader          AdvanReader"));
  EXPECT_THAT(text.out, HasSubstr("not started"));
  EXPECT_THAT(text.out, HasSubstr("GEN2_SESSION"));
  const Json info = last_event(run_program({"reader", "info", "--json"}).out, "reader");
  EXPECT_TRUE(info["parameters"]["RF_READ_POWER"].is_string()) << info;
}

TEST(CmdReader, WatchCountsReadsOfEveryAntenna) {
  const Json end = end_of({"--for", "5s"});
  EXPECT_EQ(end["link"], "open");
  EXPECT_GT(end["rounds"], 0);
  EXPECT_GT(end["tags"], 20) << "40 tags hang before the front antenna";
  EXPECT_TRUE(end["why_none"].is_null());
  EXPECT_LT(end["age_s"], 2.0);
  ASSERT_EQ(end["ports"].size(), 4U);
  const Json& front = end["ports"][0];
  EXPECT_EQ(front["name"], "front");
  EXPECT_GT(front["tags"], end["ports"][2]["tags"]) << "behind there is nothing";
  EXPECT_GE(front["strongest_dbm"], front["rssi_dbm"]);
}

TEST(CmdReader, EqualSeedsPrintEqualBytesAndPlainLinesWhereThereIsNoTerminal) {
  const std::vector<std::string> watch{"reader", "watch", "--for", "3s"};
  const ProgramResult result = run_program(watch);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out.find('\x1b'), std::string::npos);
  EXPECT_THAT(result.out, HasSubstr("link open"));
  EXPECT_THAT(result.out, HasSubstr("front"));
  EXPECT_EQ(run_program(watch).out, result.out);
}

TEST(CmdReader, SaysWhyNothingIsHeard) {
  EXPECT_THAT(end_of({"--for", "7s", "--power", "0"})["why_none"].get<std::string>(), HasSubstr("power"));
  EXPECT_THAT(end_of({"--for", "7s", "--sensitivity", "-20"})["why_none"].get<std::string>(),
              HasSubstr("weaker than -20 dBm"));
  EXPECT_THAT(end_of({"--for", "7s", "--ports", "1"})["why_none"].get<std::string>(),
              HasSubstr("no antenna at port 1"));
}

TEST(CmdReader, ASessionThatKeepsTagsSilentIsNamed) {
  const ProgramResult result = run_program({"reader", "watch", "--for", "20s", "--session", "S2", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("session S2 keeps tags silent"));
}

TEST(CmdReader, TooFewTagsIsACheckThatFails) {
  const ProgramResult result =
      run_program({"reader", "watch", "--for", "2s", "--power", "0", "--least", "1"});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_EQ(result.err, "forager: 0 different tags were heard, fewer than the 1 of --least\n");
}

TEST(CmdReader, StartStopAndInputs) {
  EXPECT_THAT(run_program({"reader", "start"}).out, HasSubstr("reading"));
  EXPECT_THAT(run_program({"reader", "stop"}).out, HasSubstr("the radio is off"));
  const ProgramResult lines = run_program({"reader", "gpio", "list"});
  EXPECT_EQ(lines.exit_code, 0) << lines.err;
  EXPECT_EQ(lines.out,
            "input 1   low\n"
            "input 2   low\n"
            "input 3   low\n"
            "input 4   low\n"
            "outputs   10\n");
  const ProgramResult set = run_program({"reader", "gpio", "set", "1", "--hold", "500ms", "--arm"});
  EXPECT_EQ(set.exit_code, 0) << set.err;
  EXPECT_EQ(set.out, "output 1 on for 0.5 s\noutput 1 off\n");
}

TEST(CmdReader, RefusesWhatCannotWork) {
  expect_refusals({
      {{"reader"}, 2, "info, watch, start, stop, gpio"},
      {{"reader", "watch"}, 2, "--for"},
      {{"reader", "watch", "--for", "soon"}, 2, "soon"},
      {{"reader", "watch", "--for", "1", "--session", "S9"}, 2, "S9"},
      {{"reader", "watch", "--for", "1", "--power", "40"}, 2, "40"},
      {{"reader", "watch", "--for", "1", "--power", "10.3"}, 2, "10.3"},
      {{"reader", "watch", "--for", "1", "--ports", "33"}, 2, "33"},
      {{"reader", "gpio", "set", "1", "--hold", "1s"}, 2, "--arm"},
      {{"reader", "info", "--board", "no/such.toml"}, 3, "no/such.toml"},
  });
}

TEST(CmdReaderWedge, AReaderThatTypesIsWatchedByTheNameOfTheBoardFile) {
  const test::ScratchFolder folder;
  const std::string board =
      folder.write("robot.toml",
                   "[board]\nname = \"robot\"\n[[wedge]]\nname = \"gate\"\npath = \"sim\"\nepc_digits = 24\n"
                   "[[wedge]]\nname = \"desk\"\nvendor = 0x1209\nproduct = 0xffff\n");
  const ProgramResult result =
      run_program({"reader", "watch", "--wedge", "gate", "--board", board, "--for", "3200ms", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Json end = last_event(result.out, "end");
  EXPECT_EQ(end["reads"], 6) << result.out;  // one every half second
  EXPECT_EQ(end["tags"], 6);
  EXPECT_EQ(end["ports"][0]["name"], "typed");
  expect_refusals({{{"reader", "watch", "--wedge", "door", "--board", board}, 2, "gate, desk"},
                   {{"reader", "watch", "--wedge", "gate", "--board", board}, 2, "--for"}});
  if (!built_with("hidapi")) return;
  expect_refusals({{{"hid", "watch", "door", "--board", board}, 2, "gate, desk"},
                   {{"hid", "watch", "gate", "--board", board}, 2, "reader watch --wedge gate"}});
}

// Against `forager emulate reader` over real sockets.
class CmdReaderOverSockets : public SocketTest {
 protected:
  [[nodiscard]] std::vector<std::string> with_board(std::vector<std::string> arguments) const {
    for (const std::string& more : {std::string("--board"), rig_.file("board.toml")})
      arguments.push_back(more);
    return arguments;
  }
  SocketRig rig_;
};

TEST_F(CmdReaderOverSockets, WatchHearsTagsAndLeavesTheReaderStopped) {
  rig_.start_reader();
  const ProgramResult result = run_program(with_board({"reader", "watch", "--for", "4s", "--json"}));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Json end = last_event(result.out, "end");
  EXPECT_EQ(end["link"], "open");
  EXPECT_GT(end["reads"], 0) << result.out;
  const ProgramResult info = run_program(with_board({"reader", "info"}));
  EXPECT_THAT(info.out, HasSubstr("STOPPED: not started")) << info.err;
}

TEST_F(CmdReaderOverSockets, CtrlCStopsTheRadio) {
  rig_.start_reader();
  Program program(with_board({"reader", "watch", "--json"}));
  ASSERT_TRUE(program.wait_for_out("\"link\":\"open\"", kPatience)) << program.so_far().err;
  program.send_signal(SIGINT);
  EXPECT_EQ(program.finish().exit_code, 0);
  EXPECT_THAT(run_program(with_board({"reader", "info"})).out, HasSubstr("STOPPED"));
}

TEST_F(CmdReaderOverSockets, AReaderSomebodyElseStopsIsNoticed) {
  rig_.start_reader();
  Program program(with_board({"reader", "watch", "--json"}));
  ASSERT_TRUE(program.wait_for_out("\"link\":\"open\"", kPatience)) << program.so_far().err;
  EXPECT_EQ(run_program(with_board({"reader", "stop"})).exit_code, 0);
  EXPECT_TRUE(program.wait_for_out("the reader reports STOPPED", kPatience)) << program.so_far().out;
}

// One program has the reader at work; a second one listens, and the first notices nothing of it.
TEST_F(CmdReaderOverSockets, ListeningLeavesAReaderThatRunsForSomebodyElseAlone) {
  rig_.start_reader();
  Program first(with_board({"reader", "watch", "--json"}));
  ASSERT_TRUE(first.wait_for_out("\"link\":\"open\"", kPatience)) << first.so_far().err;
  Program listener(with_board({"reader", "watch", "--listen", "--json"}));
  EXPECT_TRUE(listener.wait_until(
      [](const ProgramResult& it) {
        const Json moment = last_event(it.out, "reads");
        return !moment.is_null() && moment["reads"] > 0;
      },
      kPatience))
      << listener.so_far().out << listener.so_far().err;
  listener.send_signal(SIGINT);
  const ProgramResult heard = listener.finish();
  EXPECT_EQ(heard.exit_code, 0) << heard.err;
  EXPECT_THAT(run_program(with_board({"reader", "info"})).out, HasSubstr("RUNNING"));
  EXPECT_TRUE(first.running());
  first.send_signal(SIGINT);
  const ProgramResult result = first.finish();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(last_event(result.out, "end")["link_losses"], 0);
}

TEST_F(CmdReaderOverSockets, AStoppedReaderIsListenedToAndNotStarted) {
  rig_.start_reader();
  const ProgramResult result =
      run_program(with_board({"reader", "watch", "--listen", "--for", "2s", "--json"}));
  EXPECT_EQ(result.exit_code, 0) << result.err;  // there was no time for a keep-alive
  EXPECT_EQ(last_event(result.out, "end")["reads"], 0);
  EXPECT_THAT(run_program(with_board({"reader", "info"})).out, HasSubstr("STOPPED"));
  expect_refusals({{with_board({"reader", "watch", "--listen", "--power", "20"}), 2, "--listen"},
                   {{"reader", "watch", "--listen"}, 2, "--host"}});
}

TEST_F(CmdReaderOverSockets, AReaderThatIsNotThereIsNamedWithTheMend) {
  const ProgramResult info = run_program(with_board({"reader", "info"}));
  EXPECT_EQ(info.exit_code, 1);
  EXPECT_THAT(info.err, HasSubstr("nobody listens there"));
  const ProgramResult watch = run_program(with_board({"reader", "watch", "--for", "1s", "--json"}));
  EXPECT_EQ(watch.exit_code, 1);
  EXPECT_THAT(last_event(watch.out, "end")["why_none"].get<std::string>(), HasSubstr("the link is down"));
  EXPECT_THAT(watch.err, HasSubstr("nobody listens there"));
}

TEST_F(CmdReaderOverSockets, AWrongPasswordIsTold) {
  ProgramOptions options;
  options.environment = {{"READER_PASSWORD", "right"}};
  rig_.start_reader({"--user", "robot", "--password-env", "READER_PASSWORD"}, options);
  const ProgramResult bare = run_program(with_board({"reader", "info"}));
  EXPECT_EQ(bare.exit_code, 1);
  EXPECT_THAT(bare.err, HasSubstr("password"));
}

}  // namespace
}  // namespace forager::tools
