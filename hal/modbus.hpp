#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "hal/error.hpp"

namespace forager::hal {

// A Modbus client (master) on one serial line or TCP connection. Addresses count from 0, as on the wire: what
// a manual calls 40001 is holding register 0. Registers are 16 bits; scale, sign and word order are the
// device's business and its driver's.
//
// One call is one request and its answer, and blocks until then, at most for the time-out the bus was opened
// with: keep that below the control loop's period, or ask less often.
//
// Errors of every call: invalid_argument (unit outside 0..247; nothing, or more registers than one frame
// holds: 125 to read, 123 to write; nothing was sent), timeout (silence: slave off, wrong unit, wrong baud
// rate, broken wire), protocol (CRC error, the answer of another unit, or one that does not fit the question:
// noise, two slaves with one number, wrong parity), refused (the slave answered with an exception, whose
// number and meaning the message gives), busy (exception 6: try again later), disconnected (adapter
// unplugged, connection closed: the next call connects anew), not_present and permission (of the serial
// port), io. After an error of a write the slave may have taken it or not.
class Modbus {
 public:
  virtual ~Modbus() = default;

  // Function 3.
  [[nodiscard]] Result<> read_holding(std::uint8_t unit, std::uint16_t address,
                                      std::span<std::uint16_t> into);
  // Function 4.
  [[nodiscard]] Result<> read_input(std::uint8_t unit, std::uint16_t address, std::span<std::uint16_t> into);
  // Function 6 for one register, 16 for several.
  [[nodiscard]] Result<> write_holding(std::uint8_t unit, std::uint16_t address,
                                       std::span<const std::uint16_t> values);
  // Function 5.
  [[nodiscard]] Result<> write_coil(std::uint8_t unit, std::uint16_t address, bool on);

  // "modbus /dev/ttyUSB0", "modbus 192.168.1.30:502".
  [[nodiscard]] std::string_view name() const { return do_name(); }

 protected:
  enum class Table : std::uint8_t { holding, input };

 private:
  Result<> check(std::uint8_t unit, std::uint16_t address, std::size_t count, std::size_t most,
                 std::string_view operation) const;
  // What a backend writes: unit and counts are valid.
  virtual Result<> do_read(Table table, std::uint8_t unit, std::uint16_t address,
                           std::span<std::uint16_t> into) = 0;
  virtual Result<> do_write(std::uint8_t unit, std::uint16_t address,
                            std::span<const std::uint16_t> values) = 0;
  virtual Result<> do_write_coil(std::uint8_t unit, std::uint16_t address, bool on) = 0;
  [[nodiscard]] virtual std::string_view do_name() const = 0;
};

// The Failure of an exception a slave answered with (Modbus application protocol V1.1b3, section 7).
[[nodiscard]] Failure modbus_exception(std::string_view device, std::string_view operation,
                                       std::uint8_t exception);

}  // namespace forager::hal
