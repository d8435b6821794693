#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "hal/digital_in.hpp"
#include "hal/digital_out.hpp"
#include "hal/error.hpp"
#include "hal/hid.hpp"
#include "hal/i2c.hpp"
#include "hal/mcp2221.hpp"
#include "hal/time.hpp"

namespace forager::boards {

// The MCP2221A bridges that a board file names where it could name a bus or a chip of the kernel: "mcp2221"
// for the only one that is plugged in, "mcp2221:SN0001" for the one with this serial number. Each is opened
// once, with the first thing that needs it, and shared by everything on it.
class UsbBridges {
 public:
  // hid: null for this machine's, opened with the first bridge.
  explicit UsbBridges(hal::Hid* hid = nullptr) : hid_(hid) {}

  // Whether `place` names a bridge.
  [[nodiscard]] static bool named(std::string_view place);

  // The number of a pin is that of its line. What they hand out may not outlive this object. Errors: those of
  // Hid::open() and Mcp2221::open(); invalid_argument (a line that is not GP0 to GP3).
  [[nodiscard]] hal::Result<std::unique_ptr<hal::I2c>> i2c(const std::string& place, hal::Duration timeout);
  [[nodiscard]] hal::Result<std::unique_ptr<hal::DigitalOut>> output(const std::string& place,
                                                                     const std::string& line,
                                                                     hal::Mcp2221Pin pin);
  [[nodiscard]] hal::Result<std::unique_ptr<hal::DigitalIn>> input(const std::string& place,
                                                                   const std::string& line, bool active_low);

 private:
  struct Pin {
    hal::Mcp2221* bridge = nullptr;
    std::uint8_t number = 0;
  };
  hal::Result<Pin> pin(const std::string& place, const std::string& line);
  hal::Result<hal::Mcp2221*> bridge(const std::string& place, hal::Duration timeout);

  hal::Hid* hid_;
  std::unique_ptr<hal::Hid> own_hid_;
  std::map<std::string, std::unique_ptr<hal::Mcp2221>> bridges_;  // by their path
};

}  // namespace forager::boards
