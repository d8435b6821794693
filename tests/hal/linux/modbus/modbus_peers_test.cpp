#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>

#include "hal/linux/modbus_bus.hpp"
#include "hal/linux/serial_port.hpp"
#include "hal/linux/tcp_listener.hpp"
#include "mocks/virtual_clock.hpp"
#include "tests/hal/eventually.hpp"
#include "tests/hal/linux/modbus/line_pump.hpp"
#include "tests/hal/linux/modbus/served_slave.hpp"
#include "tests/places.hpp"

// Against implementations that are nobody's here: python3-pymodbus as the slave, mbpoll as the master.
namespace forager::hal {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

struct Output {
  int status = -1;
  std::string text;
};

Output run(const std::string& command) {
  Output output;
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return output;
  std::array<char, 512> part{};
  while (std::fgets(part.data(), part.size(), pipe) != nullptr) output.text += part.data();
  output.status = ::pclose(pipe);
  return output;
}

// A program that runs until the end of the object.
class Program {
 public:
  explicit Program(std::vector<std::string> arguments) {
    process_ = ::fork();
    if (process_ != 0) return;
    std::vector<char*> raw;
    for (std::string& argument : arguments) raw.push_back(argument.data());
    raw.push_back(nullptr);
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, 1);
    ::dup2(nowhere, 2);
    ::execvp(raw[0], raw.data());
    ::_exit(127);
  }
  ~Program() {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

 private:
  pid_t process_ = -1;
};

// Debian's own, whose packages these are.
const std::string kPython = "/usr/bin/python3";
const std::string kSlave = test::source_path("tests/hal/linux/modbus/pymodbus_slave.py");

bool has_pymodbus(const std::string& modules) {
  return run(kPython + " -c 'import " + modules + "'").status == 0;
}

void expect_a_whole_slave(Modbus& bus) {
  std::array<std::uint16_t, 2> two{};
  ASSERT_TRUE(contract::eventually([&] { return bus.read_holding(7, 10, two).has_value(); }));
  EXPECT_EQ((std::array<std::uint16_t, 2>{0x1234, 0x5678}), two);
  ASSERT_TRUE(bus.write_holding(7, 12, std::array<std::uint16_t, 1>{0xBEEF}));
  ASSERT_TRUE(bus.write_holding(7, 13, std::array<std::uint16_t, 2>{1, 0xFFFF}));
  std::array<std::uint16_t, 3> three{};
  ASSERT_TRUE(bus.read_holding(7, 12, three));
  EXPECT_EQ((std::array<std::uint16_t, 3>{0xBEEF, 1, 0xFFFF}), three);
  ASSERT_TRUE(bus.read_input(7, 20, two));
  EXPECT_EQ((std::array<std::uint16_t, 2>{0x1234, 0xFFFE}), two);
  EXPECT_TRUE(bus.write_coil(7, 3, true));
  const auto beyond = bus.read_holding(7, 19, two);
  ASSERT_FALSE(beyond);
  EXPECT_EQ(ErrorCode::refused, beyond.error().code);
  EXPECT_THAT(beyond.error().detail, HasSubstr("exception 2"));
  EXPECT_EQ(ErrorCode::timeout, bus.read_holding(8, 10, two).error().code);
  EXPECT_TRUE(bus.read_holding(7, 10, two));
}

TEST(ModbusPeers, OurMasterSpeaksToPymodbusOnASerialLineAndThroughItsFaults) {
  if (!has_pymodbus("pymodbus.server, serial_asyncio"))
    GTEST_SKIP() << "needs Debian's python3-pymodbus and python3-serial-asyncio";
  contract::LinePump line;
  const Program slave({kPython, kSlave, "rtu", line.far()});
  const auto bus =
      open_modbus_rtu({.device = line.near(), .baud = 19200, .parity = 'N', .timeout = 500ms}).value();
  expect_a_whole_slave(*bus);
  std::array<std::uint16_t, 2> two{};
  line.spoil(contract::LineFault::flip_a_bit);
  EXPECT_EQ(ErrorCode::protocol, bus->read_holding(7, 10, two).error().code);
  EXPECT_TRUE(bus->read_holding(7, 10, two));
  line.spoil(contract::LineFault::drop);
  EXPECT_EQ(ErrorCode::timeout, bus->read_holding(7, 10, two).error().code);
  EXPECT_TRUE(bus->read_holding(7, 10, two));
}

TEST(ModbusPeers, OurMasterSpeaksToPymodbusOverTcp) {
  if (!has_pymodbus("pymodbus.server")) GTEST_SKIP() << "needs Debian's python3-pymodbus";
  const std::uint16_t port = TcpListener::listen("127.0.0.1", 0).value().port();
  const Program slave({kPython, kSlave, "tcp", std::to_string(port)});
  const auto bus = open_modbus_tcp({.host = "127.0.0.1", .port = port, .timeout = 500ms}).value();
  expect_a_whole_slave(*bus);
}

TEST(ModbusPeers, MbpollReadsAndWritesOurEmulatedSlave) {
  if (run("mbpoll -V").status != 0) GTEST_SKIP() << "needs Debian's mbpoll";
  const mocks::VirtualClock clock;
  contract::LinePump line;
  contract::ServedSlave slave(open_serial_port({.device = line.far()}, clock), 7);
  slave.with_device([](auto& device) {
    device.holding = {{10, 4660}, {11, 0}};
    device.input = {{20, 22136}};
    device.coils[3] = false;
  });
  const std::string mbpoll = "mbpoll -m rtu -a 7 -b 19200 -P none -0 -1 -o 1 ";
  const Output holding = run(mbpoll + "-t 4 -r 10 -c 2 " + line.near());
  EXPECT_EQ(0, holding.status) << holding.text;
  EXPECT_THAT(holding.text, HasSubstr("[10]: \t4660"));
  EXPECT_THAT(run(mbpoll + "-t 3 -r 20 " + line.near()).text, HasSubstr("[20]: \t22136"));
  EXPECT_THAT(run(mbpoll + "-t 4 -r 11 " + line.near() + " 777").text, HasSubstr("Written 1 reference"));
  EXPECT_EQ(777, slave.with_device([](auto& device) { return device.holding.at(11); }));
  EXPECT_THAT(run(mbpoll + "-t 0 -r 3 " + line.near() + " 1").text, HasSubstr("Written 1 reference"));
  EXPECT_TRUE(slave.with_device([](auto& device) { return device.coils.at(3); }));
  EXPECT_THAT(run(mbpoll + "-t 4 -r 12 " + line.near()).text, HasSubstr("Illegal data address"));
}

}  // namespace
}  // namespace forager::hal
