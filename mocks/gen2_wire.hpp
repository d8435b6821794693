#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace forager::mocks {

// A command or reply on the Gen2 air interface as bits, most significant first.
class Gen2Bits {
 public:
  static constexpr std::size_t kCapacity = 528;  // a reply with the longest EPC

  Gen2Bits() = default;
  // Appends the low `width` bits (0..32) of value, its highest one first. What exceeds the capacity is
  // dropped.
  Gen2Bits& push(std::uint32_t value, std::size_t width);
  [[nodiscard]] bool operator[](std::size_t i) const { return bits_[i] != 0; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t ones() const;
  bool operator==(const Gen2Bits&) const = default;

 private:
  std::array<std::uint8_t, kCapacity> bits_{};
  std::size_t size_ = 0;
};

// CRC-5 of Query: x^5 + x^3 + 1, preset 01001, no final inversion. Over data and CRC it is 0.
[[nodiscard]] std::uint8_t gen2_crc5(const Gen2Bits& bits);
// CRC-16 of everything else: x^16 + x^12 + x^5 + 1, preset FFFF, sent inverted.
[[nodiscard]] std::uint16_t gen2_crc16(const Gen2Bits& bits);
// Register before the inversion: over data and CRC it is this.
inline constexpr std::uint16_t kGen2Crc16Residue = 0x1D0F;
[[nodiscard]] std::uint16_t gen2_crc16_register(const Gen2Bits& bits);

enum class Gen2Target : std::uint8_t { a = 0, b = 1 };
enum class Gen2Select : std::uint8_t { all = 0, not_sl = 2, sl = 3 };
enum class Gen2UpDn : std::uint8_t { same = 0b000, up = 0b110, down = 0b011 };

// Fields of Query (Gen2 v1.2.0 sec. 6.3.2.11.2.1).
struct Gen2Query {
  bool dr_64_3 = true;      // divide ratio 64/3, else 8
  std::uint8_t m_log2 = 2;  // 0..3: FM0, Miller 2, 4, 8
  bool trext = false;
  Gen2Select sel = Gen2Select::all;
  std::uint8_t session = 0;  // 0..3
  Gen2Target target = Gen2Target::a;
  std::uint8_t q = 4;  // 0..15
  bool operator==(const Gen2Query&) const = default;
};
[[nodiscard]] Gen2Bits encode_query(const Gen2Query& query);                        // 22 bits
[[nodiscard]] Gen2Bits encode_query_rep(std::uint8_t session);                      // 4
[[nodiscard]] Gen2Bits encode_query_adjust(std::uint8_t session, Gen2UpDn change);  // 9
[[nodiscard]] Gen2Bits encode_ack(std::uint16_t rn16);                              // 18
[[nodiscard]] Gen2Bits encode_nak();                                                // 8

// Fields of Select. Target 0..3: the inventoried flag of S0..S3, 4: SL. Action 0..7: what matching / other
// tags do: 0 assert or A / deassert or B; 1 assert / -; 2 - / deassert; 3 negate / -; 4 deassert / assert;
// 5 deassert / -; 6 - / assert; 7 - / negate.
struct Gen2SelectCommand {
  std::uint8_t target = 4;
  std::uint8_t action = 0;
  std::uint8_t bank = 1;         // 1 EPC, 2 TID, 3 user
  std::uint32_t pointer = 0x20;  // bit address, below 2^21: three EBV bytes
  Gen2Bits mask;                 // at most 255 bits
  bool truncate = false;
};
[[nodiscard]] Gen2Bits encode_select(const Gen2SelectCommand& select);  // 45 bits and the mask; EBV pointer

// Protocol control word: length in words (0..31) in its five highest bits, UMI 0400, XI 0200, T 0100.
[[nodiscard]] std::uint16_t gen2_pc_word(std::size_t epc_words, bool umi = false, bool xi = false);
// Reply to ACK: PC, EPC (an even number of bytes, 62 at most), CRC-16.
[[nodiscard]] Gen2Bits encode_epc_reply(std::span<const std::uint8_t> epc, bool umi = false);

}  // namespace forager::mocks
