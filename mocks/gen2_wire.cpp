#include "mocks/gen2_wire.hpp"

#include <algorithm>

namespace forager::mocks {
namespace {

std::uint32_t crc(const Gen2Bits& bits, std::uint32_t preset, std::uint32_t polynomial, unsigned width) {
  const std::uint32_t top = 1U << (width - 1U);
  const std::uint32_t all = (top << 1U) - 1U;
  std::uint32_t value = preset;
  for (std::size_t i = 0; i < bits.size(); ++i) {
    const bool carry = ((value & top) != 0) != bits[i];
    value = (value << 1U) & all;
    if (carry) value ^= polynomial;
  }
  return value;
}

}  // namespace

Gen2Bits& Gen2Bits::push(std::uint32_t value, std::size_t width) {
  for (std::size_t i = width; i-- > 0 && size_ < kCapacity;)
    bits_[size_++] = static_cast<std::uint8_t>((value >> i) & 1U);
  return *this;
}

std::size_t Gen2Bits::ones() const {
  return static_cast<std::size_t>(
      std::count(bits_.begin(), bits_.begin() + static_cast<std::ptrdiff_t>(size_), std::uint8_t{1}));
}

std::uint8_t gen2_crc5(const Gen2Bits& bits) {
  return static_cast<std::uint8_t>(crc(bits, 0b01001, 0b01001, 5));
}

std::uint16_t gen2_crc16_register(const Gen2Bits& bits) {
  return static_cast<std::uint16_t>(crc(bits, 0xFFFF, 0x1021, 16));
}

std::uint16_t gen2_crc16(const Gen2Bits& bits) {
  return static_cast<std::uint16_t>(gen2_crc16_register(bits) ^ 0xFFFFU);
}

Gen2Bits encode_query(const Gen2Query& q) {
  Gen2Bits bits;
  bits.push(0b1000, 4).push(q.dr_64_3 ? 1 : 0, 1).push(q.m_log2, 2).push(q.trext ? 1 : 0, 1);
  bits.push(static_cast<std::uint32_t>(q.sel), 2).push(q.session, 2);
  bits.push(static_cast<std::uint32_t>(q.target), 1).push(q.q, 4);
  return bits.push(gen2_crc5(bits), 5);
}

Gen2Bits encode_query_rep(std::uint8_t session) { return Gen2Bits().push(0b00, 2).push(session, 2); }

Gen2Bits encode_query_adjust(std::uint8_t session, Gen2UpDn change) {
  return Gen2Bits().push(0b1001, 4).push(session, 2).push(static_cast<std::uint32_t>(change), 3);
}

Gen2Bits encode_ack(std::uint16_t rn16) { return Gen2Bits().push(0b01, 2).push(rn16, 16); }

Gen2Bits encode_nak() { return Gen2Bits().push(0b11000000, 8); }

Gen2Bits encode_select(const Gen2SelectCommand& s) {
  Gen2Bits bits;
  bits.push(0b1010, 4).push(s.target, 3).push(s.action, 3).push(s.bank, 2);
  // Extensible bit vector: seven bits a byte, the highest bit says that another byte follows.
  for (unsigned byte = 2; byte > 0; --byte)
    if ((s.pointer >> (7U * byte)) != 0) bits.push(0x80U | ((s.pointer >> (7U * byte)) & 0x7FU), 8);
  bits.push(s.pointer & 0x7FU, 8);
  const std::size_t mask = std::min<std::size_t>(s.mask.size(), 255);
  bits.push(static_cast<std::uint32_t>(mask), 8);
  for (std::size_t i = 0; i < mask; ++i) bits.push(s.mask[i] ? 1 : 0, 1);
  bits.push(s.truncate ? 1 : 0, 1);
  return bits.push(gen2_crc16(bits), 16);
}

std::uint16_t gen2_pc_word(std::size_t epc_words, bool umi, bool xi) {
  return static_cast<std::uint16_t>(((epc_words & 0x1FU) << 11U) | (umi ? 0x0400U : 0U) |
                                    (xi ? 0x0200U : 0U));
}

Gen2Bits encode_epc_reply(std::span<const std::uint8_t> epc, bool umi) {
  const auto kept = epc.first(std::min<std::size_t>(epc.size() / 2, 31) * 2);
  Gen2Bits bits;
  bits.push(gen2_pc_word(kept.size() / 2, umi), 16);
  for (const std::uint8_t byte : kept) bits.push(byte, 8);
  return bits.push(gen2_crc16(bits), 16);
}

}  // namespace forager::mocks
