#include "mocks/sim_modbus_slave.hpp"

#include "mocks/modbus_crc.hpp"

namespace forager::mocks {
namespace {

constexpr std::size_t kTcpHeader = 6;  // transaction, protocol, length

std::uint16_t word(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

void append(std::vector<std::uint8_t>& to, std::uint16_t value) {
  to.push_back(static_cast<std::uint8_t>(value >> 8));
  to.push_back(static_cast<std::uint8_t>(value & 0xFF));
}

std::vector<std::uint8_t> exception(std::uint8_t function, std::uint8_t code) {
  return {static_cast<std::uint8_t>(function | 0x80), code};
}

}  // namespace

// Of the frame that begins in pending_; 0: not known yet.
std::size_t SimModbusSlave::frame_size() const {
  if (framing_ == Framing::tcp) return pending_.size() < kTcpHeader ? 0 : kTcpHeader + word(pending_, 4);
  if (pending_.size() < 2) return 0;
  if (pending_[1] != 16) return 8;  // unit, function, two words, CRC
  return pending_.size() < 7 ? 0 : 9U + pending_[6];
}

std::vector<std::uint8_t> SimModbusSlave::feed(std::span<const std::uint8_t> bytes) {
  pending_.insert(pending_.end(), bytes.begin(), bytes.end());
  std::vector<std::uint8_t> out;
  for (std::size_t size = frame_size(); size != 0 && pending_.size() >= size; size = frame_size()) {
    const auto reply = answer(std::span(pending_).first(size));
    out.insert(out.end(), reply.begin(), reply.end());
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(size));
  }
  return out;
}

std::vector<std::uint8_t> SimModbusSlave::answer(std::span<const std::uint8_t> frame) {
  const bool rtu = framing_ == Framing::rtu;
  const std::size_t head = rtu ? 0 : kTcpHeader;
  if (frame.size() < head + 2) return {};
  if (rtu && modbus_crc(frame) != 0) return {};  // over data and CRC together it is zero
  if (frame[head] != unit_) return {};
  ++requests;
  if (fault == Fault::silent) return {};
  const auto pdu = execute(frame.subspan(head + 1, frame.size() - head - 1 - (rtu ? 2 : 0)));
  std::vector<std::uint8_t> out;
  if (!rtu) {
    out.assign(frame.begin(), frame.begin() + 4);
    append(out, static_cast<std::uint16_t>(pdu.size() + 1));
  }
  out.push_back(fault == Fault::wrong_unit ? static_cast<std::uint8_t>(unit_ + 1) : unit_);
  out.insert(out.end(), pdu.begin(), pdu.end());
  if (rtu) {
    append_modbus_crc(out);
    if (fault == Fault::wrong_crc) out.back() ^= 1U;
  }
  if (fault == Fault::truncated) out.resize(out.size() / 2);
  return out;
}

std::vector<std::uint8_t> SimModbusSlave::read(std::uint8_t function, std::uint16_t from,
                                               std::uint16_t count) {
  const auto& table = function == 3 ? holding : input;
  if (count == 0 || count > 125) return exception(function, 3);
  std::vector<std::uint8_t> out{function, static_cast<std::uint8_t>(2 * count)};
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto found = table.find(static_cast<std::uint16_t>(from + i));
    if (found == table.end()) return exception(function, 2);
    append(out, found->second);
  }
  return out;
}

std::vector<std::uint8_t> SimModbusSlave::execute(std::span<const std::uint8_t> pdu) {
  const std::uint8_t function = pdu[0];
  if (exception_next) {
    const std::uint8_t code = *exception_next;
    exception_next.reset();
    return exception(function, code);
  }
  if (pdu.size() < 5) return exception(function, 3);
  const std::uint16_t from = word(pdu, 1);
  const std::uint16_t value = word(pdu, 3);
  if (function == 3 || function == 4) return read(function, from, value);
  std::vector<std::uint8_t> echo(pdu.begin(), pdu.begin() + 5);
  if (function == 5) {
    if (coils.count(from) == 0) return exception(function, 2);
    if (value != 0x0000 && value != 0xFF00) return exception(function, 3);
    coils[from] = value != 0;
    return echo;
  }
  if (function == 6) {
    if (holding.count(from) == 0) return exception(function, 2);
    holding[from] = value;
    return echo;
  }
  if (function != 16) return exception(function, 1);
  if (value == 0 || value > 123 || pdu.size() != 6U + 2U * value) return exception(function, 3);
  for (std::uint32_t i = 0; i < value; ++i)
    if (holding.count(static_cast<std::uint16_t>(from + i)) == 0) return exception(function, 2);
  for (std::uint32_t i = 0; i < value; ++i)
    holding[static_cast<std::uint16_t>(from + i)] = word(pdu, 6 + 2 * i);
  return echo;
}

}  // namespace forager::mocks
