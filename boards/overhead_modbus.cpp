#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "boards/overhead_contest.hpp"
#include "hal/linux/bare_calls.hpp"
#include "hal/linux/modbus_bus.hpp"
#include "hal/linux/pseudo_terminal.hpp"
#include "mocks/sim_modbus_slave.hpp"

namespace forager::boards {
namespace {

constexpr std::uint8_t kUnit = 1;
constexpr std::uint16_t kRegisters = 4;

// An emulated device at the far end of a line. It never sleeps, so that what is timed is the near end.
class Device {
 public:
  explicit Device(std::unique_ptr<hal::PseudoTerminal> line) : line_(std::move(line)) {
    for (std::uint16_t i = 0; i < kRegisters; ++i) slave_.holding[i] = i;
    thread_ = std::thread([this] {
      while (!stop_.load(std::memory_order_relaxed))
        if (!serve()) std::this_thread::yield();
    });
  }
  ~Device() {
    stop_.store(true, std::memory_order_relaxed);
    thread_.join();
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  [[nodiscard]] const std::string& port() const { return line_->port(); }

 private:
  // Whether there was anything to do.
  bool serve() {
    const auto state = line_->poll();
    if (!state || *state == hal::StreamState::closed) static_cast<void>(line_->open());
    if (!state || *state != hal::StreamState::open) return false;
    const auto got = line_->read(std::as_writable_bytes(std::span(bytes_)));
    if (!got || *got == 0) return false;
    const auto answer = slave_.feed(std::span(bytes_).first(*got));
    return line_->write(std::as_bytes(std::span(answer))).has_value();
  }

  std::unique_ptr<hal::PseudoTerminal> line_;
  mocks::SimModbusSlave slave_{kUnit, mocks::SimModbusSlave::Framing::rtu};
  std::array<std::uint8_t, 256> bytes_{};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

hal::ModbusRtuConfig line_to(const Device& device) {
  return {.device = device.port(), .baud = 115200, .parity = 'N', .timeout = std::chrono::seconds(1)};
}

hal::Result<OverheadContest::Side> open_ours(const std::shared_ptr<Device>& device) {
  auto opened = hal::open_modbus_rtu(line_to(*device));
  if (!opened) return hal::fail(std::move(opened).error());
  const auto run = [device, bus = std::shared_ptr<hal::Modbus>(*std::move(opened))](
                       std::uint64_t calls) -> hal::Result<std::uint64_t> {
    std::array<std::uint16_t, kRegisters> into{};
    for (std::uint64_t i = 0; i < calls; ++i) FORAGER_TRY(bus->read_holding(kUnit, 0, into));
    return calls;
  };
  return OverheadContest::Side(run);
}

}  // namespace

hal::Result<OverheadContest> overhead_modbus() {
  auto line = hal::open_pseudo_terminal();
  if (!line) return hal::fail(std::move(line).error());
  const auto device = std::make_shared<Device>(*std::move(line));
  const auto bare = [device] { return hal::open_bare_modbus(line_to(*device), kUnit, kRegisters); };
  if (const auto tried = bare(); !tried) return hal::fail(tried.error());
  return OverheadContest{.name = "Modbus round trip",
                         .ours = "Modbus::read_holding",
                         .bare = hal::modbus_library(),
                         .unit = "call",
                         .batch = std::chrono::milliseconds(5),
                         .open_ours = [device] { return open_ours(device); },
                         .open_bare = bare};
}

}  // namespace forager::boards
