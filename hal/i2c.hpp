#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "hal/error.hpp"

namespace forager::hal {

// A controller of an I2C bus. One call is one transfer from START to STOP; nobody else's bytes come between.
// A call blocks for as long as the bus takes, at most the time-out the bus was opened with.
//
//   write        S addr W [A] byte [A] ... P
//   read         S addr R [A] byte A ... byte N P
//   write_read   S addr W [A] byte [A] ... Sr addr R [A] byte A ... byte N P
//
// Errors of every transfer: invalid_argument (address outside 0x08..0x77: the rest is reserved by the
// specification; nothing to transfer, or more than the adapter takes; nothing was sent), no_ack (no chip at
// that address, it has no power, SDA or SCL swapped, or it refused a byte), timeout (a chip holds SCL low),
// busy (another controller won the bus, or the kernel's own driver holds the address), permission,
// disconnected (USB adapter unplugged), unsupported (adapter without combined transfers), io (bus stuck low,
// no pull-ups). After an error any number of bytes may have reached the chip.
class I2c {
 public:
  virtual ~I2c() = default;

  [[nodiscard]] Result<> write(std::uint8_t address, std::span<const std::byte> bytes) {
    return transfer(address, bytes, {});
  }
  // Fills all of `into`.
  [[nodiscard]] Result<> read(std::uint8_t address, std::span<std::byte> into) {
    return transfer(address, {}, into);
  }
  [[nodiscard]] Result<> write_read(std::uint8_t address, std::span<const std::byte> bytes,
                                    std::span<std::byte> into) {
    return transfer(address, bytes, into);
  }

  // "i2c /dev/i2c-1".
  [[nodiscard]] std::string_view name() const { return do_name(); }

 private:
  Result<> transfer(std::uint8_t address, std::span<const std::byte> bytes, std::span<std::byte> into);
  // What a backend writes: address and sizes are valid, at least one span is not empty.
  virtual Result<> do_transfer(std::uint8_t address, std::span<const std::byte> bytes,
                               std::span<std::byte> into) = 0;
  [[nodiscard]] virtual std::string_view do_name() const = 0;
};

}  // namespace forager::hal
