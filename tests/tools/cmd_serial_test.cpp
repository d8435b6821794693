// `forager serial` from outside, on pseudo terminals of the kernel.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/linux/pseudo_terminal.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/tools/bench_command.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/socket_rig.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

// The device at the other end of the line.
class CmdSerialTest : public testing::Test {
 protected:
  void SetUp() override {
    auto made = hal::open_pseudo_terminal();
    ASSERT_TRUE(made) << hal::describe(made.error());
    far_ = *std::move(made);
    static_cast<void>(far_->open());
  }
  [[nodiscard]] const std::string& port() const { return far_->port(); }
  std::string receive() {
    std::array<std::byte, 4096> room;
    static_cast<void>(far_->poll());
    const auto count = far_->read(room);
    return count ? std::string(reinterpret_cast<const char*>(room.data()), *count) : std::string();
  }
  void send(std::string_view text) {
    static_cast<void>(far_->poll());
    static_cast<void>(far_->write(std::as_bytes(std::span(text))));
  }
  // Lets the program and the far end talk until the condition holds.
  template <class Step>
  bool talk(Program& program, const Step& step) {
    return program.wait_until([&](const ProgramResult&) { return step(); }, 20s);
  }
  std::unique_ptr<hal::PseudoTerminal> far_;
};

TEST_F(CmdSerialTest, WatchPrintsWhatComes) {
  Program program({"serial", "watch", port(), "--baud", "57600"});
  ASSERT_TRUE(program.wait_for_err("57600 8N1", 20s)) << program.so_far().err;
  send("hello\n");
  ASSERT_TRUE(program.wait_for_out("hello\n", 20s)) << program.so_far().err;
  program.send_signal(SIGINT);
  const ProgramResult result = program.finish();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "hello\n");
  EXPECT_THAT(result.err, HasSubstr("6 bytes received, 0 sent"));
}

TEST_F(CmdSerialTest, ANameOfTheBoardFileBringsPortBaudRateAndParity) {
  const test::ScratchFolder folder;
  const std::string board = folder.write(
      "robot.toml", "[board]\nname = \"robot\"\n[[serial]]\nname = \"scale\"\nbaud = 4800\nport = \"" +
                        port() +
                        "\"\n[[serial]]\nname = \"meter\"\nport = \"/dev/ttyUSB77\"\nparity = \"even\"\n");
  Program program({"serial", "watch", "scale", "--board", board});
  ASSERT_TRUE(program.wait_for_err("4800 8N1", 20s)) << program.so_far().err;
  send("12.5 kg\n");
  EXPECT_TRUE(program.wait_for_out("12.5 kg\n", 20s)) << program.so_far().err;
  EXPECT_THAT(run_program({"serial", "list", "--board", board}).out,
              HasSubstr("scale is " + port() + " at 4800 8N1\nmeter is /dev/ttyUSB77 at 115200 8E1\n"));
  expect_refusal({"serial", "watch", "scales", "--board", board}, 2, HasSubstr("names scale, meter"));
  expect_refusal({"serial", "watch", "scale"}, 2, HasSubstr("neither a name"));
}

TEST_F(CmdSerialTest, WatchInHexTellsBytesApart) {
  Program program({"serial", "watch", port(), "--hex"});
  ASSERT_TRUE(program.wait_for_err("8N1", 20s)) << program.so_far().err;
  send(std::string_view("\x00\xff!", 3));
  ASSERT_TRUE(program.wait_for_out("00 ff 21", 20s)) << program.so_far().out;
  EXPECT_THAT(program.so_far().out, HasSubstr("..!"));
}

TEST_F(CmdSerialTest, EchoSendsBackWhatComes) {
  Program program({"serial", "echo", port(), "--json"});
  ASSERT_TRUE(program.wait_for_err("8N1", 20s)) << program.so_far().err;
  send("ping");
  std::string back;
  EXPECT_TRUE(talk(program, [&] { return (back += receive()) == "ping"; })) << back;
  program.send_signal(SIGTERM);
  const ProgramResult result = program.finish();
  EXPECT_EQ(last_event(result.out, "end")["sent"], 4) << result.out;
}

TEST_F(CmdSerialTest, LoopbackCountsWhatComesBack) {
  Program good({"serial", "loopback", port(), "--bytes", "2000", "--json"});
  EXPECT_FALSE(talk(good, [&] {  // until it has ended
    send(receive());
    return false;
  }));
  const ProgramResult result = good.finish();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Json report = last_event(result.out, "loopback");
  EXPECT_EQ(report["back"], 2000);
  EXPECT_EQ(report["wrong"], 0);
}

TEST_F(CmdSerialTest, LoopbackNoticesNoiseAndAnOpenLine) {
  Program noisy({"serial", "loopback", port(), "--bytes", "200", "--json"});
  bool struck = false;
  talk(noisy, [&] {
    std::string piece = receive();
    if (!piece.empty() && !std::exchange(struck, true)) piece[0] = static_cast<char>(piece[0] ^ 0x10);
    send(piece);
    return false;
  });
  const ProgramResult wrong = noisy.finish();
  EXPECT_EQ(wrong.exit_code, 4);
  EXPECT_EQ(last_event(wrong.out, "loopback")["wrong"], 1) << wrong.out;
  EXPECT_EQ(last_event(wrong.out, "loopback")["first_wrong"], 0);

  const ProgramResult open = run_program({"serial", "loopback", port()});
  EXPECT_EQ(open.exit_code, 4);
  EXPECT_THAT(open.err, HasSubstr("TX and RX"));
}

TEST_F(CmdSerialTest, BaudSaysWhatMakesSense) {
  Program program({"serial", "baud", port(), "--rates", "9600,57600", "--for", "300ms"});
  talk(program, [&] {
    send("$GPGGA,line of text\r\n");
    static_cast<void>(receive());
    return false;
  });
  const ProgramResult result = program.finish();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("    9600 baud"));
  EXPECT_THAT(result.out, HasSubstr("  text\n"));

  const ProgramResult silent = run_program({"serial", "baud", port(), "--rates", "9600", "--for", "100ms"});
  EXPECT_EQ(silent.exit_code, 4);
  EXPECT_THAT(silent.out, HasSubstr("    9600 baud       0 bytes  nothing\n"));
  EXPECT_THAT(silent.err, HasSubstr("nothing came at any rate"));
}

TEST_F(CmdSerialTest, AnAdapterThatIsUnpluggedEndsIt) {
  Program program({"serial", "watch", port()});
  ASSERT_TRUE(program.wait_for_err("8N1", 20s)) << program.so_far().err;
  const std::string name = port();
  far_.reset();
  const ProgramResult result = program.finish();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr(name));
}

TEST(CmdSerial, RefusesWhatCannotWork) {
  expect_refusals({
      {{"serial"}, 2, "list, watch, terminal, echo, loopback, baud"},
      {{"serial", "watch"}, 2, "device"},
      {{"serial", "watch", "/dev/ttyUSB77"}, 3, "/dev/ttyUSB77"},
      {{"serial", "watch", "/dev/ttyUSB77", "--format", "9N1"}, 2, "9N1"},
      {{"serial", "terminal", "/dev/ttyUSB77"}, 2, "--arm"},
      {{"serial", "baud", "/dev/ttyUSB77", "--rates", "fast"}, 2, "fast"},
  });
}

TEST(CmdSerial, ListNamesPortsOrSaysThatThereAreNone) {
  const ProgramResult result = run_program({"serial", "list"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  if (result.out.empty()) {
    EXPECT_EQ(result.err, "forager: this machine has no serial port\n");
  }
}

}  // namespace
}  // namespace forager::tools
