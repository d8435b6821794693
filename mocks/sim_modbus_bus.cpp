#include "mocks/sim_modbus_bus.hpp"

#include <fmt/format.h>

#include "mocks/modbus_crc.hpp"

namespace forager::mocks {
namespace {

void append(std::vector<std::uint8_t>& to, std::size_t value) {
  to.push_back(static_cast<std::uint8_t>(value >> 8 & 0xFF));
  to.push_back(static_cast<std::uint8_t>(value & 0xFF));
}

std::vector<std::uint8_t> request(std::uint8_t function, std::uint16_t address, std::size_t value) {
  std::vector<std::uint8_t> pdu{function};
  append(pdu, address);
  append(pdu, value);
  return pdu;
}

std::string range(const char* what, std::uint8_t unit, std::uint16_t from, std::size_t count) {
  return fmt::format("{} {} to {} of unit {}", what, from, from + count - 1, unit);
}

}  // namespace

hal::Result<std::vector<std::uint8_t>> SimModbusBus::exchange(std::uint8_t unit,
                                                              std::vector<std::uint8_t> pdu,
                                                              const std::string& operation) {
  const auto failed = [&](hal::ErrorCode code, const char* detail) {
    return hal::fail(code, name_, operation, detail);
  };
  if (unplugged_) return failed(hal::ErrorCode::disconnected, "the line is gone");
  ++exchanges;
  const std::uint8_t function = pdu[0];
  pdu.insert(pdu.begin(), unit);
  append_modbus_crc(pdu);
  std::vector<std::uint8_t> heard;
  for (SimModbusSlave* slave : slaves_) {
    slave->silence();  // a request begins after a pause on the line
    const auto answer = slave->feed(pdu);
    heard.insert(heard.end(), answer.begin(), answer.end());
  }
  if (heard.size() < 5) return failed(hal::ErrorCode::timeout, "no answer");
  if (modbus_crc(heard) != 0) return failed(hal::ErrorCode::protocol, "the answer's CRC is wrong");
  if (heard[0] != unit) return failed(hal::ErrorCode::protocol, "another unit answered");
  if (heard[1] == (function | 0x80)) return hal::modbus_exception(name_, operation, heard[2]);
  return std::vector<std::uint8_t>(heard.begin() + 2, heard.end() - 2);
}

hal::Result<> SimModbusBus::do_read(Table table, std::uint8_t unit, std::uint16_t address,
                                    std::span<std::uint16_t> into) {
  const std::string operation = range("read registers", unit, address, into.size());
  const auto answer =
      exchange(unit, request(table == Table::holding ? 3 : 4, address, into.size()), operation);
  if (!answer) return hal::fail(answer.error());
  if (answer->size() != 1 + 2 * into.size())
    return hal::fail(hal::ErrorCode::protocol, name_, operation, "the answer does not fit the question");
  for (std::size_t i = 0; i < into.size(); ++i)
    into[i] = static_cast<std::uint16_t>((*answer)[1 + 2 * i] << 8 | (*answer)[2 + 2 * i]);
  return {};
}

hal::Result<> SimModbusBus::do_write(std::uint8_t unit, std::uint16_t address,
                                     std::span<const std::uint16_t> values) {
  std::vector<std::uint8_t> pdu =
      request(values.size() == 1 ? 6 : 16, address, values.size() == 1 ? values[0] : values.size());
  if (values.size() > 1) {
    pdu.push_back(static_cast<std::uint8_t>(2 * values.size()));
    for (const std::uint16_t value : values) append(pdu, value);
  }
  const auto answer = exchange(unit, std::move(pdu), range("write registers", unit, address, values.size()));
  return answer ? hal::Result<>() : hal::Result<>(hal::fail(answer.error()));
}

hal::Result<> SimModbusBus::do_write_coil(std::uint8_t unit, std::uint16_t address, bool on) {
  const auto answer = exchange(unit, request(5, address, on ? 0xFF00 : 0),
                               fmt::format("write coil {} of unit {}", address, unit));
  return answer ? hal::Result<>() : hal::Result<>(hal::fail(answer.error()));
}

}  // namespace forager::mocks
