#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/digital_in.hpp"
#include "hal/digital_out.hpp"
#include "hal/digital_out_group.hpp"
#include "hal/hid.hpp"
#include "hal/i2c.hpp"
#include "hal/mcp2221_wire.hpp"
#include "hal/time.hpp"

namespace forager::hal {

struct Mcp2221Config {
  HidMatch device{};                                // vendor and product are filled in
  std::uint32_t i2c_hz = 100'000;                   // 46'512 to 400'000: what the divider and the bus can do
  Duration reply = std::chrono::milliseconds(100);  // the longest the chip may take to answer a report
  Duration i2c_timeout = std::chrono::milliseconds(50);  // the longest a transfer may take on the bus
};

struct Mcp2221Pin {
  std::uint8_t number = 0;  // 0 to 3: GP0 to GP3
  bool active_low = false;
  bool keep_at_end = false;   // outputs: the level stays when the object ends; else they end inactive
  bool begin_active = false;  // outputs: the first level
};

// An MCP2221A: four pins and an I2C bus at the end of a USB cable, so that a computer without pins can drive
// a bench. One report to the chip and its answer take two frames of USB, so a pin is set in about 2 ms and an
// I2C write of up to 60 bytes takes about 4 ms. What the pins do otherwise (LEDs, ADC, interrupt) ends for a
// pin that is opened here, until the chip's next reset; nothing is written to its flash.
//
// Errors of every exchange, beside those of HidDevice: timeout (no answer within `reply`), protocol (the
// answer of another command). When the program dies the pins keep their levels: what must be safe then needs
// a brake that locks without a signal.
class Mcp2221 {
 public:
  // Errors: those of Hid::open(); busy says when the kernel's own driver has it; invalid_argument (i2c_hz).
  [[nodiscard]] static Result<std::unique_ptr<Mcp2221>> open(Hid& hid, const Mcp2221Config& config);
  ~Mcp2221();
  Mcp2221(const Mcp2221&) = delete;
  Mcp2221& operator=(const Mcp2221&) = delete;

  // Pins borrow the bridge. An output begins at its first level, without a spike. Errors: invalid_argument
  // (no such pin), busy (the pin is open already), those of an exchange.
  [[nodiscard]] Result<std::unique_ptr<DigitalOut>> output(const Mcp2221Pin& pin);
  [[nodiscard]] Result<std::unique_ptr<DigitalIn>> input(const Mcp2221Pin& pin);
  // They change together, in one report.
  [[nodiscard]] Result<std::unique_ptr<DigitalOutGroup>> outputs(std::span<const Mcp2221Pin> pins);

  // Of the bus: no_ack, timeout (SCL or SDA held low), busy, io, and those of an exchange.
  [[nodiscard]] I2c& i2c();

  // "mcp2221 SN0001".
  [[nodiscard]] const std::string& name() const { return name_; }
  // "hardware A6, firmware 12".
  [[nodiscard]] const std::string& version() const { return version_; }

 private:
  using Report = std::array<std::byte, mcp2221::kReportBytes>;
  class Out;
  class In;
  class Group;
  // Takes pins for one object, and gives them back with it.
  class Lease {
   public:
    Lease(Mcp2221& bridge, std::vector<Mcp2221Pin> pins);
    ~Lease();
    Lease(Lease&& other) noexcept;
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    Lease& operator=(Lease&&) = delete;

    [[nodiscard]] const std::vector<Mcp2221Pin>& pins() const { return pins_; }
    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] Mcp2221& bridge() const { return *bridge_; }
    void end_inactive();  // of outputs, as far as they should and the chip still listens

   private:
    Mcp2221* bridge_;
    std::vector<Mcp2221Pin> pins_;
    std::string name_;
  };

  Mcp2221(std::unique_ptr<HidDevice> device, const Mcp2221Config& config);
  // Sends a report and waits for its answer.
  [[nodiscard]] Result<Report> exchange(const Report& request, std::string_view operation);
  [[nodiscard]] Result<> start();
  [[nodiscard]] Result<Lease> lease(std::span<const Mcp2221Pin> pins, bool input);
  [[nodiscard]] Result<> set_pins(const Lease& lease, std::span<const bool> active);
  [[nodiscard]] Result<bool> pin_active(const Lease& lease);

  std::unique_ptr<HidDevice> device_;
  Mcp2221Config config_;
  std::string name_;
  std::string version_;
  std::array<std::uint8_t, mcp2221::kPins> pins_{};  // as in kSetSram, with the levels last set
  std::array<bool, mcp2221::kPins> taken_{};
  std::unique_ptr<I2c> bus_;
};

}  // namespace forager::hal
