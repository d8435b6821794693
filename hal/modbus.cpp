#include "hal/modbus.hpp"

#include <fmt/format.h>

#include "hal/success.hpp"

namespace forager::hal {
namespace {

// Modbus application protocol V1.1b3: sections 6.3 and 6.12.
constexpr std::size_t kMostRead = 125;
constexpr std::size_t kMostWritten = 123;
constexpr std::uint8_t kLastUnit = 247;

std::string_view meaning_of(std::uint8_t exception) {
  switch (exception) {
    case 1:
      return "illegal function: the device does not know this request";
    case 2:
      return "illegal data address: the device has no such register";
    case 3:
      return "illegal data value";
    case 4:
      return "the device failed";
    case 5:
      return "acknowledged, it takes longer";
    case 6:
      return "the device is busy";
    case 8:
      return "memory parity error";
    case 10:
      return "the gateway has no path to the device";
    case 11:
      return "the device behind the gateway does not answer";
    default:
      return "an exception the specification does not know";
  }
}

}  // namespace

Failure modbus_exception(std::string_view device, std::string_view operation, std::uint8_t exception) {
  return fail(exception == 6 ? ErrorCode::busy : ErrorCode::refused, std::string(device),
              std::string(operation), fmt::format("exception {}, {}", exception, meaning_of(exception)),
              exception == 2 ? "Compare the register map with the device's manual" : "");
}

Result<> Modbus::check(std::uint8_t unit, std::uint16_t address, std::size_t count, std::size_t most,
                       std::string_view operation) const {
  if (unit > kLastUnit)
    return fail(ErrorCode::invalid_argument, std::string(name()), std::string(operation),
                fmt::format("unit {} is not from 0 to {}", unit, kLastUnit));
  if (count == 0 || count > most || address + count > 65536)
    return fail(ErrorCode::invalid_argument, std::string(name()), std::string(operation),
                fmt::format("{} registers from {} on: from 1 to {} fit into a frame", count, address, most));
  return success();
}

Result<> Modbus::read_holding(std::uint8_t unit, std::uint16_t address, std::span<std::uint16_t> into) {
  FORAGER_TRY(check(unit, address, into.size(), kMostRead, "read holding registers"));
  return do_read(Table::holding, unit, address, into);
}

Result<> Modbus::read_input(std::uint8_t unit, std::uint16_t address, std::span<std::uint16_t> into) {
  FORAGER_TRY(check(unit, address, into.size(), kMostRead, "read input registers"));
  return do_read(Table::input, unit, address, into);
}

Result<> Modbus::write_holding(std::uint8_t unit, std::uint16_t address,
                               std::span<const std::uint16_t> values) {
  FORAGER_TRY(check(unit, address, values.size(), kMostWritten, "write holding registers"));
  return do_write(unit, address, values);
}

Result<> Modbus::write_coil(std::uint8_t unit, std::uint16_t address, bool on) {
  FORAGER_TRY(check(unit, address, 1, 1, "write coil"));
  return do_write_coil(unit, address, on);
}

}  // namespace forager::hal
