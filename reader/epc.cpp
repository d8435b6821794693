#include "reader/epc.hpp"

#include <algorithm>
#include <cstring>

namespace forager::reader {
namespace {

// Value of a hexadecimal digit, 0xFF for anything else.
constexpr std::array<std::uint8_t, 256> make_digit_table() {
  std::array<std::uint8_t, 256> table{};
  for (auto& entry : table) entry = 0xFF;
  for (std::uint8_t i = 0; i < 10; ++i) table[static_cast<std::size_t>('0') + i] = i;
  for (std::uint8_t i = 0; i < 6; ++i) {
    table[static_cast<std::size_t>('a') + i] = static_cast<std::uint8_t>(10 + i);
    table[static_cast<std::size_t>('A') + i] = static_cast<std::uint8_t>(10 + i);
  }
  return table;
}
constexpr auto kDigit = make_digit_table();

hal::Failure bad_epc(std::string_view what, std::string detail) {
  // A hostile peer may send megabytes; nobody wants them in an error line.
  return hal::fail(hal::ErrorCode::invalid_argument, "EPC",
                   std::string(what.substr(0, 2 * Epc::kMaxBytes + 4)), std::move(detail),
                   "an EPC has 2 to 62 bytes in steps of two");
}

std::uint64_t mix(std::uint64_t x) {
  x ^= x >> 32;
  x *= 0xD6E8FEB86659FD93ULL;
  x ^= x >> 32;
  x *= 0xD6E8FEB86659FD93ULL;
  return x ^ (x >> 32);
}

}  // namespace

hal::Result<Epc> Epc::from_hex(std::string_view hex) {
  if (hex.empty()) return bad_epc(hex, "is empty");
  if (hex.size() > 2 * kMaxBytes) return bad_epc(hex, "is longer than 62 bytes");
  if (hex.size() % 4 != 0) return bad_epc(hex, "is not a whole number of 16-bit words");
  Epc epc;
  epc.size_ = static_cast<std::uint8_t>(hex.size() / 2);
  unsigned seen = 0;
  for (std::size_t i = 0; i < epc.size_; ++i) {
    const unsigned high = kDigit[static_cast<unsigned char>(hex[2 * i])];
    const unsigned low = kDigit[static_cast<unsigned char>(hex[2 * i + 1])];
    seen |= high | low;
    epc.bytes_[i] = static_cast<std::uint8_t>((high << 4U) | (low & 0x0FU));
  }
  if (seen > 0x0F) return bad_epc(hex, "is not hexadecimal");
  return epc;
}

hal::Result<Epc> Epc::from_bytes(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return bad_epc("from bytes", "is empty");
  if (bytes.size() > kMaxBytes) return bad_epc("from bytes", "is longer than 62 bytes");
  if (bytes.size() % 2 != 0) return bad_epc("from bytes", "is not a whole number of 16-bit words");
  Epc epc;
  epc.size_ = static_cast<std::uint8_t>(bytes.size());
  std::ranges::copy(bytes, epc.bytes_.begin());
  return epc;
}

std::string Epc::hex() const {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  text.reserve(2U * size_);
  for (const std::uint8_t byte : bytes()) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 0x0FU];
  }
  return text;
}

std::uint64_t Epc::hash() const {
  std::uint64_t state = 0x9E3779B97F4A7C15ULL ^ size_;
  for (std::size_t at = 0; at < size_; at += 8) {
    std::uint64_t word = 0;  // the bytes behind the end are zero, so a short tail needs no care
    std::memcpy(&word, bytes_.data() + at, std::min<std::size_t>(8, kMaxBytes - at));
    state = mix(state ^ word) + 0x9E3779B97F4A7C15ULL;
  }
  return state;
}

}  // namespace forager::reader
