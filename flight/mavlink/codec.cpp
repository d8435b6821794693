#include "flight/mavlink/codec.hpp"

#include "flight/mavlink/crc.hpp"

namespace forager::flight::mavlink::detail {
namespace {

void append_crc(FrameBuffer& buffer, std::size_t end, std::uint8_t crc_extra) {
  const std::uint16_t crc = crc_add(crc_add(kCrcStart, {buffer.data() + 1, end - 1}), crc_extra);
  buffer.data()[end] = std::byte(crc & 0xFFU);
  buffer.data()[end + 1] = std::byte(crc >> 8U);
  buffer.set_size(end + kCrcSize);
}

}  // namespace

void seal_v2(FrameBuffer& buffer, std::uint32_t id, std::size_t full_length, std::uint8_t crc_extra,
             Sender& sender, std::uint8_t incompat_flags) {
  std::byte* const p = buffer.data();
  std::size_t length = full_length;
  while (length > 1 && p[kHeaderV2 + length - 1] == std::byte{0}) --length;
  p[0] = std::byte{kStxV2};
  p[1] = std::byte(length);
  p[2] = std::byte{incompat_flags};
  p[3] = std::byte{0};
  p[4] = std::byte{sender.next_sequence++};
  p[5] = std::byte{sender.sysid};
  p[6] = std::byte{sender.compid};
  p[7] = std::byte(id & 0xFFU);
  p[8] = std::byte((id >> 8U) & 0xFFU);
  p[9] = std::byte((id >> 16U) & 0xFFU);
  append_crc(buffer, kHeaderV2 + length, crc_extra);
}

void seal_v1(FrameBuffer& buffer, std::uint32_t id, std::size_t base_length, std::uint8_t crc_extra,
             Sender& sender) {
  std::byte* const p = buffer.data();
  p[0] = std::byte{kStxV1};
  p[1] = std::byte(base_length);
  p[2] = std::byte{sender.next_sequence++};
  p[3] = std::byte{sender.sysid};
  p[4] = std::byte{sender.compid};
  p[5] = std::byte(id & 0xFFU);
  append_crc(buffer, kHeaderV1 + base_length, crc_extra);
}

}  // namespace forager::flight::mavlink::detail
