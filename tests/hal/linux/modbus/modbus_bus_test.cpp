#include "hal/linux/modbus_bus.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <pty.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <mutex>
#include <thread>

#include "mocks/sim_modbus_slave.hpp"
#include "tests/hal/modbus_contract.hpp"

namespace forager::hal {
namespace {

using namespace std::chrono_literals;
using mocks::SimModbusSlave;
using testing::HasSubstr;

// An emulated device behind a real pseudo-terminal or socket, served by a thread of its own.
class Slave {
 public:
  explicit Slave(SimModbusSlave::Framing framing) : device(7, framing) {
    for (std::uint16_t i = 10; i < 20; ++i) device.holding[i] = 0;
    device.input = {{20, 0x1234}, {21, 0xFFFE}};
    device.coils[3] = false;
    framing == SimModbusSlave::Framing::rtu ? open_terminal() : listen_on_socket();
    pump_ = std::thread([this] { pump(); });
  }
  ~Slave() { unplug(); }
  Slave(const Slave&) = delete;
  Slave& operator=(const Slave&) = delete;

  void unplug() {
    stop_ = true;
    if (pump_.joinable()) pump_.join();
    for (int* fd : {&line_, &listener_, &terminal_end_})
      if (*fd >= 0) ::close(std::exchange(*fd, -1));
  }
  template <class Change>
  auto with_device(Change change) {
    const std::scoped_lock lock(mutex_);
    return change(device);
  }

  std::string path;        // of the terminal
  std::uint16_t port = 0;  // of the socket
  SimModbusSlave device;   // by with_device() only, once the thread runs

 private:
  void open_terminal() {
    std::array<char, 128> name{};
    if (::openpty(&line_, &terminal_end_, name.data(), nullptr, nullptr) != 0) std::abort();
    path = name.data();
  }
  void listen_on_socket() {
    listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 || ::listen(listener_, 1) != 0 ||
        ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
      std::abort();
    port = ntohs(address.sin_port);
  }
  void pump() {
    while (!stop_) {
      pollfd wait{line_ >= 0 ? line_ : listener_, POLLIN, 0};
      if (::poll(&wait, 1, 2) <= 0) continue;
      if (line_ < 0) {
        line_ = ::accept(listener_, nullptr, nullptr);
        continue;
      }
      std::array<std::uint8_t, 300> bytes{};
      const ssize_t got = ::read(line_, bytes.data(), bytes.size());
      if (got <= 0) {
        std::this_thread::sleep_for(1ms);
        continue;
      }
      const auto reply = with_device([&](SimModbusSlave& slave) {
        return slave.feed(std::span(bytes).first(static_cast<std::size_t>(got)));
      });
      if (!reply.empty()) static_cast<void>(!::write(line_, reply.data(), reply.size()));
    }
  }

  int line_ = -1;
  int listener_ = -1;
  int terminal_end_ = -1;
  std::atomic<bool> stop_ = false;
  std::mutex mutex_;
  std::thread pump_;
};

class Rig final : public contract::ModbusRig {
 public:
  explicit Rig(SimModbusSlave::Framing framing) : slave_(framing) {
    bus_ = framing == SimModbusSlave::Framing::rtu
               ? open_modbus_rtu({.device = slave_.path, .baud = 115200, .parity = 'N', .timeout = 300ms})
                     .value()
               : open_modbus_tcp({.host = "127.0.0.1", .port = slave_.port, .timeout = 300ms}).value();
  }
  Modbus& bus() override { return *bus_; }
  std::uint16_t holding(std::uint16_t address) override {
    return slave_.with_device([&](SimModbusSlave& device) { return device.holding.at(address); });
  }
  bool coil(std::uint16_t address) override {
    return slave_.with_device([&](SimModbusSlave& device) { return device.coils.at(address); });
  }
  void unplug() override { slave_.unplug(); }
  Slave& slave() { return slave_; }

 private:
  Slave slave_;
  std::unique_ptr<Modbus> bus_;
};

class ModbusRtu : public testing::Test {
 protected:
  ErrorCode code_with(SimModbusSlave::Fault fault) {
    rig_.slave().with_device([&](SimModbusSlave& device) { device.fault = fault; });
    const auto read = rig_.bus().read_holding(7, 10, two_);
    rig_.slave().with_device([&](SimModbusSlave& device) { device.fault = SimModbusSlave::Fault::none; });
    EXPECT_TRUE(rig_.bus().read_holding(7, 10, two_)) << "it must recover at once";
    return read ? ErrorCode::invalid_state : read.error().code;
  }
  Rig rig_{SimModbusSlave::Framing::rtu};
  std::array<std::uint16_t, 2> two_{};
};

TEST_F(ModbusRtu, EachFaultOfTheLineHasItsOwnName) {
  EXPECT_EQ(ErrorCode::timeout, code_with(SimModbusSlave::Fault::silent));
  EXPECT_EQ(ErrorCode::protocol, code_with(SimModbusSlave::Fault::wrong_crc));
  EXPECT_EQ(ErrorCode::protocol, code_with(SimModbusSlave::Fault::wrong_unit));
  EXPECT_EQ(ErrorCode::timeout, code_with(SimModbusSlave::Fault::truncated));
}

TEST_F(ModbusRtu, ExceptionsComeWithTheirMeaning) {
  const auto with = [&](std::uint8_t exception) {
    rig_.slave().with_device([&](SimModbusSlave& device) { device.exception_next = exception; });
    return rig_.bus().read_holding(7, 10, two_).error();
  };
  EXPECT_EQ(ErrorCode::busy, with(6).code);
  EXPECT_EQ(ErrorCode::refused, with(4).code);
  EXPECT_THAT(describe(with(1)), HasSubstr("illegal function"));
}

TEST(ModbusOpening, ImpossibleSettingsAndMissingPortsAreToldApart) {
  EXPECT_EQ(ErrorCode::invalid_argument, open_modbus_rtu({.device = "", .baud = 9600}).error().code);
  EXPECT_EQ(ErrorCode::invalid_argument, open_modbus_rtu({.device = "/dev/x", .baud = 0}).error().code);
  const auto bus = open_modbus_rtu({.device = "/dev/no-such-port"});
  ASSERT_TRUE(bus);
  std::array<std::uint16_t, 1> one{};
  EXPECT_EQ(ErrorCode::not_present, (*bus)->read_holding(1, 0, one).error().code);
}

}  // namespace

namespace contract {
INSTANTIATE_TEST_SUITE_P(
    Libmodbus, ModbusContract,
    testing::Values(ModbusRigMaker{"Rtu", [] { return std::make_unique<Rig>(SimModbusSlave::Framing::rtu); }},
                    ModbusRigMaker{"Tcp",
                                   [] { return std::make_unique<Rig>(SimModbusSlave::Framing::tcp); }}),
    [](const auto& rig) { return rig.param.name; });
}  // namespace contract
}  // namespace forager::hal
