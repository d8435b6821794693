#include "mocks/mavlink_peer.hpp"

#include <algorithm>

namespace forager::mocks {
namespace {

constexpr std::byte kStart1{0xFE};
constexpr std::byte kStart2{0xFD};
constexpr std::size_t kSignatureSize = 13;

// Bit by bit, as the polynomial is defined; folded into a table when the program is compiled.
constexpr std::uint16_t shift_byte(std::uint16_t crc) {
  for (int bit = 0; bit < 8; ++bit)
    crc = static_cast<std::uint16_t>((crc & 1U) != 0 ? (crc >> 1) ^ 0x8408U : crc >> 1);
  return crc;
}

constexpr auto kCrcTable = [] {
  std::array<std::uint16_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = shift_byte(static_cast<std::uint16_t>(i));
  return table;
}();

std::uint16_t crc_byte(std::uint16_t crc, std::uint8_t byte) {
  return static_cast<std::uint16_t>((crc >> 8) ^ kCrcTable[(crc ^ byte) & 0xFFU]);
}

constexpr std::byte byte_of(std::size_t value) { return static_cast<std::byte>(value & 0xFFU); }

constexpr auto kKindOfLowId = [] {
  std::array<std::uint8_t, 512> table{};
  for (std::size_t i = 0; i < peer::kKnown.size(); ++i)
    table[peer::kKnown[i].id] = static_cast<std::uint8_t>(i + 1);
  return table;
}();

const peer::MessageKind* kind_of(std::uint32_t id) {
  if (id >= kKindOfLowId.size() || kKindOfLowId[id] == 0) return nullptr;
  return &peer::kKnown[kKindOfLowId[id] - 1U];
}

}  // namespace

std::uint16_t mavlink_peer_crc(std::span<const std::byte> bytes, std::uint16_t crc) {
  for (const std::byte b : bytes) crc = crc_byte(crc, std::to_integer<std::uint8_t>(b));
  return crc;
}

std::span<const std::byte> MavlinkPeerPacker::pack(const peer::MessageKind& kind,
                                                   const MavlinkPayload& payload) {
  if (mavlink1_ && kind.id > 255) return {};
  std::size_t length = mavlink1_ ? kind.base_size : kind.full_size;
  // Version 2 drops trailing zeros but never the first byte.
  if (!mavlink1_)
    while (length > 1 && payload.get<std::uint8_t>(length - 1) == 0) --length;
  const std::size_t header = mavlink1_ ? 6 : 10;
  frame_[1] = byte_of(length);
  if (mavlink1_) {
    frame_[0] = kStart1;
    frame_[2] = byte_of(sequence_);
    frame_[3] = byte_of(system_);
    frame_[4] = byte_of(component_);
    frame_[5] = byte_of(kind.id);
  } else {
    frame_[0] = kStart2;
    frame_[2] = frame_[3] = std::byte{0};
    frame_[4] = byte_of(sequence_);
    frame_[5] = byte_of(system_);
    frame_[6] = byte_of(component_);
    frame_[7] = byte_of(kind.id);
    frame_[8] = byte_of(kind.id >> 8);
    frame_[9] = byte_of(kind.id >> 16);
  }
  ++sequence_;
  std::ranges::copy(payload.bytes(length), frame_.begin() + static_cast<std::ptrdiff_t>(header));
  const auto covered = std::span<const std::byte>(frame_).subspan(1, header - 1 + length);
  const std::uint16_t crc = crc_byte(mavlink_peer_crc(covered), kind.crc_extra);
  frame_[header + length] = byte_of(crc);
  frame_[header + length + 1] = byte_of(crc >> 8U);
  return std::span<const std::byte>(frame_).first(header + length + 2);
}

std::size_t MavlinkPeerParser::push(std::span<const std::byte> bytes) {
  if (begin_ == end_) begin_ = end_ = 0;
  if (begin_ > 0 && end_ + bytes.size() > buffer_.size()) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  const std::size_t count = std::min(bytes.size(), buffer_.size() - end_);
  std::memcpy(buffer_.data() + end_, bytes.data(), count);
  end_ += count;
  return count;
}

const MavlinkPeerFrame* MavlinkPeerParser::next() {
  while (begin_ < end_) {
    if (buffer_[begin_] != kStart1 && buffer_[begin_] != kStart2) {
      ++begin_;
      continue;
    }
    const Step step = take();
    if (step == Step::frame) return &frame_;
    if (step == Step::more) return nullptr;
    ++bad_;
    ++begin_;  // perhaps a real frame starts inside the false one
  }
  return nullptr;
}

MavlinkPeerParser::Step MavlinkPeerParser::take() {
  const auto at = [this](std::size_t i) { return std::to_integer<std::uint8_t>(buffer_[begin_ + i]); };
  const bool mavlink1 = buffer_[begin_] == kStart1;
  const std::size_t have = end_ - begin_;
  const std::size_t header = mavlink1 ? 6 : 10;
  if (have < header) return Step::more;
  const std::size_t length = at(1);
  std::size_t signature = 0;
  std::uint32_t id = at(5);
  if (!mavlink1) {
    // A flag bit that is not understood changes the layout: the frame must be thrown away.
    if ((at(2) & ~1U) != 0) return Step::reject;
    signature = (at(2) & 1U) != 0 ? kSignatureSize : 0;
    id = static_cast<std::uint32_t>(at(7) | (at(8) << 8) | (at(9) << 16));
  }
  const std::size_t total = header + length + 2 + signature;
  if (kind_of(id) == nullptr) return Step::reject;
  if (have < total) return Step::more;
  const std::size_t from = mavlink1 ? 2 : 4;
  frame_.mavlink1 = mavlink1;
  frame_.sequence = at(from);
  frame_.system = at(from + 1);
  frame_.component = at(from + 2);
  if (!decode(header, length, id)) return Step::reject;
  begin_ += total;
  return Step::frame;
}

bool MavlinkPeerParser::decode(std::size_t header, std::size_t length, std::uint32_t id) {
  const peer::MessageKind& kind = *kind_of(id);
  const auto frame = std::span<const std::byte>(buffer_).subspan(begin_);
  const std::uint16_t crc = crc_byte(mavlink_peer_crc(frame.subspan(1, header - 1 + length)), kind.crc_extra);
  if (frame[header + length] != byte_of(crc) || frame[header + length + 1] != byte_of(crc >> 8U))
    return false;
  frame_.id = id;
  // Bytes beyond the length known here are newer extensions.
  frame_.size = std::min<std::size_t>(length, kind.full_size);
  const auto room = frame_.payload.room();
  std::memcpy(room.data(), frame.data() + header, frame_.size);
  std::memset(room.data() + frame_.size, 0, room.size() - frame_.size);
  return true;
}

}  // namespace forager::mocks
