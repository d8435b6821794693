// `forager doctor` from outside: the six commonest faults, told apart by what it prints. The program is the
// real one; under it lie a machine with pins (fake_machine) and files of a test's own.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <thread>

#include "tests/places.hpp"
#include "tests/tools/doctor_rig.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;

TEST_F(CmdDoctor, AHealthyLineIsOkAndTheExitCodeSaysSo) {
  if (!built_with("libgpiod")) GTEST_SKIP() << "built without libgpiod";
  const ProgramResult result = examine(kButton);
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  EXPECT_EQ(told(result.out, "gpio stop_button"),
            "ok       board    gpio stop_button: line 5 of gpiochip0 (pinctrl-bcm2711) is free");
  EXPECT_THAT(result.out, AllOf(HasSubstr("host     kernel: "), HasSubstr("backend  libgpiod: "),
                                HasSubstr("ok       machine  gpio: gpiochip0 (pinctrl-bcm2711), 28 lines\n"),
                                HasSubstr(" 0 failed\n")));
  EXPECT_EQ(result.err, "");
}

TEST_F(CmdDoctor, NoPermission) {
  if (!built_with("libgpiod")) GTEST_SKIP() << "built without libgpiod";
  FakeMachine machine{.gpio = "forbidden", .root = folder_.path()};
  std::filesystem::create_directory(folder_.file("dev"));
  folder_.write("dev/gpiochip0", "");
  const ProgramResult result = examine(kButton, machine);
  EXPECT_EQ(result.exit_code, 4) << result.err;
  EXPECT_EQ(
      told(result.out, "gpio stop_button"),
      "failed   board    gpio stop_button: gpiochip0: the operating system forbids it [Permission denied]\n"
      "                  mend: Install boards/99-forager.rules into /etc/udev/rules.d and join the group "
      "gpio; then log in again");
}

TEST_F(CmdDoctor, WrongChipName) {
  if (!built_with("libgpiod")) GTEST_SKIP() << "built without libgpiod";
  const ProgramResult result =
      examine("[[gpio]]\nname = \"stop_button\"\nchip = \"pinctrl-bcm2835\"\nline = \"GPIO5\"\n");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_EQ(told(result.out, "gpio stop_button"),
            "failed   board    gpio stop_button: there is no GPIO chip \"pinctrl-bcm2835\"; there are "
            "pinctrl-bcm2711 (gpiochip0)\n"
            "                  mend: Write the label of one of them as chip = of the board file");
}

TEST_F(CmdDoctor, LineBusy) {
  if (!built_with("libgpiod")) GTEST_SKIP() << "built without libgpiod";
  const ProgramResult result =
      examine("[[gpio]]\nname = \"lamp\"\nchip = \"gpiochip0\"\nline = \"GPIO22\"\ndirection = \"out\"\n");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_EQ(told(result.out, "gpio lamp"),
            "failed   board    gpio lamp: gpiochip0/GPIO22: busy, \"spi0 CS1\" holds the line\n"
            "                  mend: Stop that program, or take the overlay of that driver out");
}

TEST_F(CmdDoctor, ReaderUnreachable) {
  if (!built_with("libcurl")) GTEST_SKIP() << "built without libcurl";
  // Port 1 of this machine: nobody listens there. The autopilot is not there either.
  const ProgramResult result =
      run_program({"doctor", board("[reader]\nhost = \"127.0.0.1\"\nrest_port = 1\nstream_port = 1\n"
                                   "[autopilot]\naddress = \"127.0.0.1:9\"\n",
                                   "socket")},
                  FakeMachine{}.options());
  EXPECT_EQ(result.exit_code, 4);
  const std::string why =
      "unreachable: nobody listens there [Connection refused]\n"
      "                  mend: Check the reader's power and network cable, reader.host of the board file, "
      "and "
      "ping it";
  EXPECT_EQ(told(result.out, "reader"), "failed   board    reader: http http://127.0.0.1:1: " + why);
  EXPECT_EQ(told(result.out, "reader stream"), "failed   board    reader stream: tcp 127.0.0.1:1: " + why);
  EXPECT_EQ(told(result.out, "autopilot"),
            "failed   board    autopilot: udp 127.0.0.1:9: no heartbeat within 3 s\n"
            "                  mend: Check its power, the link, and autopilot.address of the board file");
}

// The far end of a serial line, which talks all the time.
class Talker {
 public:
  explicit Talker(const std::string& text)
      : master_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)),
        text_(text + text + text + text + text + text + text + text) {
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0) throw std::runtime_error("no pty");
    thread_ = std::thread([this] {
      while (!ended_) {
        static_cast<void>(!write(master_, text_.data(), text_.size()));
        std::this_thread::sleep_for(20ms);
      }
    });
  }
  ~Talker() {
    ended_ = true;
    thread_.join();
    close(master_);
  }
  Talker(const Talker&) = delete;
  Talker& operator=(const Talker&) = delete;
  [[nodiscard]] std::string port() const { return ptsname(master_); }

 private:
  int master_;
  std::string text_;
  std::atomic<bool> ended_ = false;
  std::thread thread_;
};

std::string serial(const std::string& port, const std::string& speaks) {
  return "[[serial]]\nname = \"telemetry\"\nport = \"" + port + "\"\nbaud = 57600\nspeaks = \"" + speaks +
         "\"\n";
}

constexpr const char* kOtherRate =
    "\x80\xf8\x1c\x9e\x03\xe0\xfe\x98";  // what text at another rate looks like

std::string wrong_baud(const std::string& name, const std::string& line, const std::string& what) {
  return "failed   board    " + name + ": " + line + ": [0-9]+ bytes came and make no " + what +
         ": wrong baud rate\n"
         "                  mend: Set the same baud rate and parity at both ends: baud = of the board file";
}

TEST_F(CmdDoctor, WrongBaud) {
  const Talker talker(kOtherRate);
  for (const auto& [speaks, what] : {std::pair{"mavlink", "MAVLink"}, std::pair{"text", "text"}}) {
    const ProgramResult result = examine(serial(talker.port(), speaks));
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_THAT(told(result.out, "serial telemetry"),
                MatchesRegex(wrong_baud("serial telemetry", talker.port() + " at 57600 8N1", what)));
  }
}

// An autopilot on a serial line is listened to by the line that a mission opens.
TEST_F(CmdDoctor, AnAutopilotAtAnotherBaudRateOrUnplugged) {
  const Talker talker(kOtherRate);
  const auto on = [this](const std::string& port) {
    return run_program(
        {"doctor", board("[autopilot]\nserial = \"" + port + "\"\nflow = \"hardware\"\n", "socket")},
        FakeMachine{}.options());
  };
  const ProgramResult wrong = on(talker.port());
  EXPECT_EQ(wrong.exit_code, 4);
  EXPECT_THAT(told(wrong.out, "autopilot"),
              MatchesRegex(wrong_baud("autopilot", talker.port() + " at 57600 8N1 rts/cts", "MAVLink")));
  const ProgramResult gone = on("/dev/ttyACM77");
  EXPECT_EQ(gone.exit_code, 4);
  EXPECT_EQ(
      told(gone.out, "autopilot"),
      "failed   board    autopilot: serial /dev/ttyACM77: there is no such port [No such file or directory]\n"
      "                  mend: Check the cable and the name; see what there is: ls -l /dev/serial/by-id");
}

TEST_F(CmdDoctor, ALineThatMakesSenseIsOkAndASilentOneIsNot) {
  {
    const Talker talker("EPC 3005FB63AC1F3841EC880467\r\n");
    const ProgramResult result = examine(serial(talker.port(), "text"));
    EXPECT_EQ(result.exit_code, 0) << result.out;
    EXPECT_THAT(told(result.out, "serial telemetry"), HasSubstr("at 57600 8N1: text is heard"));
  }
  const Talker silent("");
  const ProgramResult result = examine(serial(silent.port(), "mavlink"));
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(told(result.out, "serial telemetry"),
              AllOf(HasSubstr("not one byte in 1.5 s"), Not(HasSubstr("baud rate"))));
}

TEST_F(CmdDoctor, DeviceUnplugged) {
  const ProgramResult result = examine(serial("/dev/ttyUSB77", "mavlink") +
                                       "[[modbus]]\nname = \"power\"\nbus = \"/dev/ttyUSB78\"\n"
                                       "[[modbus.device]]\nname = \"gauge\"\nunit = 4\n"
                                       "[[modbus.device.register]]\nname = \"charge\"\naddress = 0\n");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_EQ(
      told(result.out, "serial telemetry"),
      "failed   board    serial telemetry: serial /dev/ttyUSB77: there is no such port [No such file or "
      "directory]\n"
      "                  mend: Check the cable and the name; see what there is: ls -l /dev/serial/by-id");
  if (!built_with("libmodbus")) GTEST_SKIP() << "built without libmodbus";
  EXPECT_EQ(told(result.out, "modbus gauge"),
            "failed   board    modbus gauge: modbus /dev/ttyUSB78: there is no such port [No such file or "
            "directory]\n"
            "                  mend: Check the port's name, the cable and the device's power");
}

TEST_F(CmdDoctor, AReaderThatTypesIsUnplugged) {
  if (!built_with("hidapi")) GTEST_SKIP() << "built without hidapi";
  const ProgramResult result = examine("[[wedge]]\nname = \"gate\"\nvendor = 0x1209\nproduct = 0xfffe\n");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_EQ(told(result.out, "wedge gate"),
            "failed   board    wedge gate: hid 1209:fffe: no such device is plugged in\n"
            "                  mend: Check the cable; see what there is: forager hid list");
}

std::string text_of(const std::string& page) {
  std::ifstream in(test::source_path("") + page);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Who has the README and the doctor's output finds what it says, and what to do about it.
TEST(DoctorPage, HasTheSixFaultsInTheDoctorsWordsAndTheReadmeLeadsThere) {
  const std::string docs = text_of("docs/doctor.md");
  for (const char* words :
       {"the operating system forbids it [Permission denied]",
        "there is no GPIO chip \"pinctrl-bcm2835\"; there are pinctrl-bcm2711 (gpiochip0)",
        "busy, \"spi0 CS1\" holds the line",
        "unreachable: ", "bytes came and make no MAVLink: wrong baud rate", "there is no such port"})
    EXPECT_THAT(docs, HasSubstr(words));
  EXPECT_THAT(text_of("README.md"),
              AllOf(HasSubstr("forager doctor robot.toml"), HasSubstr("(docs/doctor.md)")));
}

}  // namespace
}  // namespace forager::tools
