#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hal/i2c.hpp"
#include "hal/mcp2221_wire.hpp"
#include "mocks/report_queue.hpp"
#include "mocks/sim_hid_device.hpp"

namespace forager::mocks {

// An MCP2221A (Microchip DS20005565). Declared: status with cancel and speed, the four pins by SRAM settings
// and GPIO commands, I2C write, write without stop, read, read with repeated start, and fetching data. Other
// commands are answered with "not supported", as the data sheet says, and kept in violations(); so is what a
// real chip does not define: reserved bits, a transfer on top of one, lengths of nothing. A report that is
// shorter than 64 bytes ends in zeros: Linux's driver sends such. Its I2C bus is any hal::I2c, such as a
// SimI2cBus with chips on it.
class SimMcp2221 final : public SimHidDevice {
 public:
  explicit SimMcp2221(hal::I2c& bus, std::string serial = "SN0001", std::string path = "/dev/hidraw0");

  [[nodiscard]] const hal::HidDeviceFacts& facts() const override { return facts_; }
  [[nodiscard]] std::span<const std::uint8_t> report_descriptor() const override;
  bool output(std::span<const std::byte> report) override;
  std::size_t input(std::span<std::byte> into) override { return answers_.take(into); }
  std::optional<std::size_t> get_feature(std::span<std::byte>) override { return std::nullopt; }
  bool set_feature(std::span<const std::byte>) override { return false; }
  void power(bool on) override;

  // The physical face.
  [[nodiscard]] bool level(std::size_t pin) const;      // on the wire, whoever drives it
  [[nodiscard]] bool is_output(std::size_t pin) const;  // a GPIO, driven by the chip
  void drive(std::size_t pin, bool high) { outside_.at(pin) = high; }
  [[nodiscard]] std::uint32_t i2c_hz() const;
  // How many questions a transfer takes before it has ended; 1 is the quickest.
  void set_slowness(int questions) { slowness_ = questions; }
  // SCL is held low: no transfer begins.
  void hold_bus(bool held) { held_ = held; }
  // Reports are taken and not answered.
  void hang(bool hung) { hung_ = hung; }
  [[nodiscard]] const std::vector<std::string>& violations() const { return violations_; }

 private:
  using Report = std::array<std::byte, hal::mcp2221::kReportBytes>;

  void status(const Report& request, Report& answer);
  void set_gpio(const Report& request, Report& answer);
  void get_gpio(Report& answer) const;
  void set_sram(const Report& request, Report& answer);
  void get_sram(Report& answer) const;
  void write(const Report& request, Report& answer);
  void read(const Report& request, Report& answer);
  void fetch(Report& answer);
  void reset_engine();
  void run(bool stop);
  void violation(std::string what) { violations_.push_back(std::move(what)); }

  hal::I2c* bus_;
  hal::HidDeviceFacts facts_;
  ReportQueue answers_;
  std::array<std::uint8_t, hal::mcp2221::kPins> pins_{};  // as in SRAM, with the level last set
  std::array<bool, hal::mcp2221::kPins> outside_{};
  std::uint8_t divider_ = 0;
  std::uint8_t engine_ = 0;  // its state once `pending_` has run out
  bool refused_ = false;     // no acknowledge
  int pending_ = 0;          // questions until the transfer has ended
  int slowness_ = 1;
  bool held_ = false;
  bool hung_ = false;
  std::uint8_t address_ = 0;
  std::size_t length_ = 0;           // of the write under way
  std::vector<std::byte> sending_;   // of it, so far; kept while the bus is held without a stop
  std::vector<std::byte> received_;  // not fetched yet
  std::vector<std::string> violations_;
};

}  // namespace forager::mocks
