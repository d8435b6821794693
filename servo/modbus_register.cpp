#include "servo/modbus_register.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace forager::servo {
namespace {

struct Limits {
  double min;
  double max;
};

template <class T>
constexpr Limits limits_of_type() {
  return {static_cast<double>(std::numeric_limits<T>::lowest()),
          static_cast<double>(std::numeric_limits<T>::max())};
}

Limits limits_of(RegisterType type) {
  switch (type) {
    case RegisterType::u16:
      return limits_of_type<std::uint16_t>();
    case RegisterType::i16:
      return limits_of_type<std::int16_t>();
    case RegisterType::u32:
      return limits_of_type<std::uint32_t>();
    case RegisterType::i32:
      return limits_of_type<std::int32_t>();
    case RegisterType::f32:
      break;
  }
  return limits_of_type<float>();
}

std::uint32_t joined(const ModbusRegister& quantity, const RegisterWords& raw) {
  if (words_of(quantity.type) == 1) return raw.words[0];
  const bool high_first = quantity.order == WordOrder::high_first;
  return std::uint32_t{raw.words[high_first ? 0 : 1]} << 16 | raw.words[high_first ? 1 : 0];
}

RegisterWords split(const ModbusRegister& quantity, std::uint32_t bits) {
  const auto low = static_cast<std::uint16_t>(bits & 0xFFFFU);
  const auto high = static_cast<std::uint16_t>(bits >> 16);
  if (words_of(quantity.type) == 1) return {{low, 0}, 1};
  if (quantity.order == WordOrder::high_first) return {{high, low}, 2};
  return {{low, high}, 2};
}

hal::Error with_name(hal::Error error, const ModbusRegister& quantity) {
  error.operation = fmt::format("{} ({})", error.operation, quantity.name);
  return error;
}

}  // namespace

hal::Result<> check(const ModbusRegister& quantity) {
  const auto wrong = [&](std::string detail) {
    return hal::fail(hal::ErrorCode::invalid_argument, "register " + quantity.name, "check",
                     std::move(detail));
  };
  if (quantity.scale == 0.0 || !std::isfinite(quantity.scale) || !std::isfinite(quantity.offset))
    return wrong("scale is 0, or scale or offset is no finite number");
  if (quantity.address + words_of(quantity.type) > 65536)
    return wrong(fmt::format("two registers from {} on do not exist", quantity.address));
  return {};
}

hal::Result<double> decode(const ModbusRegister& quantity, const RegisterWords& raw) {
  const std::uint32_t bits = joined(quantity, raw);
  double held = bits;
  if (quantity.type == RegisterType::i16) held = static_cast<std::int16_t>(bits);
  if (quantity.type == RegisterType::i32) held = static_cast<std::int32_t>(bits);
  if (quantity.type == RegisterType::f32) held = static_cast<double>(std::bit_cast<float>(bits));
  if (!std::isfinite(held))
    return hal::fail(hal::ErrorCode::protocol, "register " + quantity.name, "decode",
                     fmt::format("0x{:08x} is no finite number", bits),
                     "The device has no value yet, or type and word order differ from its manual");
  return quantity.offset + quantity.scale * held;
}

hal::Result<RegisterWords> encode(const ModbusRegister& quantity, double value) {
  double held = (value - quantity.offset) / quantity.scale;
  if (quantity.type != RegisterType::f32) held = std::round(held);
  const Limits limits = limits_of(quantity.type);
  if (!(held >= limits.min && held <= limits.max))
    return hal::fail(hal::ErrorCode::invalid_argument, "register " + quantity.name, "encode",
                     fmt::format("{} does not fit: it holds {} to {} {}", value,
                                 quantity.offset + quantity.scale * limits.min,
                                 quantity.offset + quantity.scale * limits.max, quantity.unit));
  if (quantity.type == RegisterType::f32)
    return split(quantity, std::bit_cast<std::uint32_t>(static_cast<float>(held)));
  return split(quantity, static_cast<std::uint32_t>(static_cast<std::int64_t>(held)));
}

hal::Result<double> read(hal::Modbus& bus, std::uint8_t unit, const ModbusRegister& quantity) {
  RegisterWords raw{.count = words_of(quantity.type)};
  const std::span<std::uint16_t> into = std::span(raw.words).first(raw.count);
  auto answered = quantity.table == RegisterTable::holding ? bus.read_holding(unit, quantity.address, into)
                                                           : bus.read_input(unit, quantity.address, into);
  if (!answered) return hal::fail(with_name(std::move(answered).error(), quantity));
  return decode(quantity, raw);
}

hal::Result<> write(hal::Modbus& bus, std::uint8_t unit, const ModbusRegister& quantity, double value) {
  if (quantity.table == RegisterTable::input)
    return hal::fail(hal::ErrorCode::invalid_argument, std::string(bus.name()), "write " + quantity.name,
                     "an input register can only be read");
  const auto raw = encode(quantity, value);
  if (!raw) return hal::fail(raw.error());
  auto written = bus.write_holding(unit, quantity.address, raw->used());
  if (!written) return hal::fail(with_name(std::move(written).error(), quantity));
  return {};
}

}  // namespace forager::servo
