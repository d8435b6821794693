#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "hal/modbus.hpp"

namespace forager::servo {

// How a quantity lies in registers of 16 bits. Modbus says the order of the bytes in a register, not that of
// the registers of a wider number: makers differ, so it is asked for.
enum class RegisterType : std::uint8_t { u16, i16, u32, i32, f32 };
enum class RegisterTable : std::uint8_t { holding, input };
enum class WordOrder : std::uint8_t { high_first, low_first };

// One quantity of a device, as its manual describes it: value = offset + scale * what the registers hold.
struct ModbusRegister {
  std::string name{};         // "voltage"
  std::uint16_t address = 0;  // from 0, as on the wire: 40001 of a manual is holding register 0
  RegisterTable table = RegisterTable::holding;
  RegisterType type = RegisterType::u16;
  WordOrder order = WordOrder::high_first;
  double scale = 1.0;
  double offset = 0.0;
  std::string unit{};  // for people: "V"
};

// Registers it takes: 1 or 2.
[[nodiscard]] constexpr std::size_t words_of(RegisterType type) {
  return type == RegisterType::u16 || type == RegisterType::i16 ? 1 : 2;
}

// Room for the widest type.
struct RegisterWords {
  std::array<std::uint16_t, 2> words{};
  std::size_t count = 1;
  [[nodiscard]] std::span<const std::uint16_t> used() const { return std::span(words).first(count); }
};

// Errors: invalid_argument (scale 0 or not finite, the second register beyond 65535).
[[nodiscard]] hal::Result<> check(const ModbusRegister& quantity);

// What registers mean. Errors: protocol (a float that is no number: the device has no value).
[[nodiscard]] hal::Result<double> decode(const ModbusRegister& quantity, const RegisterWords& raw);

// The registers nearest to a value. Errors: invalid_argument (no number, or beyond what the type holds).
[[nodiscard]] hal::Result<RegisterWords> encode(const ModbusRegister& quantity, double value);

// One exchange on the bus each. Errors: those of hal::Modbus, with the quantity's name in the operation, of
// decode() and of encode(); writing an input register is invalid_argument.
[[nodiscard]] hal::Result<double> read(hal::Modbus& bus, std::uint8_t unit, const ModbusRegister& quantity);
[[nodiscard]] hal::Result<> write(hal::Modbus& bus, std::uint8_t unit, const ModbusRegister& quantity,
                                  double value);

}  // namespace forager::servo
