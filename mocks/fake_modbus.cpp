#include "mocks/fake_modbus.hpp"

namespace forager::mocks {
namespace {

constexpr std::uint8_t kNoSuchRegister = 2;

}  // namespace

hal::Result<> FakeModbus::admit(std::uint8_t unit, std::string_view operation) {
  if (next_error_) return hal::fail(*std::exchange(next_error_, std::nullopt));
  if (disconnected_)
    return hal::fail(hal::ErrorCode::disconnected, std::string(name()), std::string(operation),
                     "the cable is out");
  if (unit != unit_)
    return hal::fail(hal::ErrorCode::timeout, std::string(name()), std::string(operation), "no answer");
  ++requests;
  return {};
}

hal::Result<> FakeModbus::do_read(Table table, std::uint8_t unit, std::uint16_t address,
                                  std::span<std::uint16_t> into) {
  FORAGER_TRY(admit(unit, "read"));
  const auto& registers = table == Table::holding ? holding : input;
  for (std::size_t i = 0; i < into.size(); ++i) {
    const auto found = registers.find(static_cast<std::uint16_t>(address + i));
    if (found == registers.end()) return hal::modbus_exception(name(), "read", kNoSuchRegister);
    into[i] = found->second;
  }
  return {};
}

hal::Result<> FakeModbus::do_write(std::uint8_t unit, std::uint16_t address,
                                   std::span<const std::uint16_t> values) {
  FORAGER_TRY(admit(unit, "write"));
  for (std::size_t i = 0; i < values.size(); ++i)
    if (holding.count(static_cast<std::uint16_t>(address + i)) == 0)
      return hal::modbus_exception(name(), "write", kNoSuchRegister);
  for (std::size_t i = 0; i < values.size(); ++i)
    holding[static_cast<std::uint16_t>(address + i)] = values[i];
  return {};
}

hal::Result<> FakeModbus::do_write_coil(std::uint8_t unit, std::uint16_t address, bool on) {
  FORAGER_TRY(admit(unit, "write coil"));
  if (coils.count(address) == 0) return hal::modbus_exception(name(), "write coil", kNoSuchRegister);
  coils[address] = on;
  return {};
}

}  // namespace forager::mocks
