#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <tuple>
#include <vector>

#include "flight/mavlink/codec.hpp"
#include "flight/mavlink/messages.hpp"
#include "flight/mavlink/parser.hpp"
#include "tools/bench_duel.hpp"

namespace forager::tools {
namespace {

using namespace flight::mavlink;

constexpr int kFrames = 64;
constexpr std::size_t kPayload = 28;
constexpr std::size_t kHeader = 10;
constexpr std::size_t kFrameBytes = kHeader + kPayload + 2;
constexpr std::uint8_t kAttitudeCrcExtra = 39;  // MAVLink common.xml, ATTITUDE

Attitude attitude(int i) {
  const float f = 0.01F * static_cast<float>(i + 1);
  return {1000U + static_cast<std::uint32_t>(i), f, -f, 2.0F * f, -2.0F * f, 0.5F * f, 3.0F};
}

auto values(const Attitude& a) {
  return std::tuple(a.time_boot_ms, a.roll, a.pitch, a.yaw, a.rollspeed, a.pitchspeed, a.yawspeed);
}

// The codec one writes first: field by field with shifts, CRC-16/MCRF4XX bit by bit.
std::uint16_t crc_step(std::uint16_t crc, std::uint8_t byte) {
  crc = static_cast<std::uint16_t>(crc ^ byte);
  for (int bit = 0; bit < 8; ++bit)
    crc = static_cast<std::uint16_t>((crc & 1U) != 0 ? (crc >> 1U) ^ 0x8408U : crc >> 1U);
  return crc;
}

using PlainFrame = std::array<std::uint8_t, kFrameBytes>;

void put_word(PlainFrame& frame, std::size_t& at, std::uint32_t word) {
  for (unsigned shift = 0; shift < 32; shift += 8) frame[at++] = static_cast<std::uint8_t>(word >> shift);
}

void plain_encode(const Attitude& a, std::uint8_t sequence, PlainFrame& frame) {
  frame = {0xFD, kPayload, 0, 0, sequence, 1, component::kOnboardComputer, 30, 0, 0};
  std::size_t at = kHeader;
  put_word(frame, at, a.time_boot_ms);
  for (const float value : {a.roll, a.pitch, a.yaw, a.rollspeed, a.pitchspeed, a.yawspeed})
    put_word(frame, at, std::bit_cast<std::uint32_t>(value));
  std::uint16_t crc = 0xFFFF;
  for (std::size_t i = 1; i < at; ++i) crc = crc_step(crc, frame[i]);
  crc = crc_step(crc, kAttitudeCrcExtra);
  frame[at++] = static_cast<std::uint8_t>(crc);
  frame[at] = static_cast<std::uint8_t>(crc >> 8U);
}

std::uint32_t get_word(const std::uint8_t* at) {
  return std::uint32_t{at[0]} | std::uint32_t{at[1]} << 8U | std::uint32_t{at[2]} << 16U |
         std::uint32_t{at[3]} << 24U;
}

// One byte at a time, as the generated C parser works.
class PlainParser {
 public:
  template <class Sink>
  void feed(std::uint8_t byte, Sink&& sink) {
    if (size_ == 0 && byte != 0xFD) return;
    frame_[size_++] = byte;
    if (size_ == 2 && byte != kPayload) size_ = 0;
    if (size_ > 1 && size_ <= kHeader + kPayload)
      crc_ = crc_step(size_ == 2 ? std::uint16_t{0xFFFF} : crc_, byte);
    if (size_ < kFrameBytes) return;
    size_ = 0;
    crc_ = crc_step(crc_, kAttitudeCrcExtra);
    if (frame_[kFrameBytes - 2] != (crc_ & 0xFFU) || frame_[kFrameBytes - 1] != crc_ >> 8U) return;
    const std::uint8_t* p = frame_.data() + kHeader;
    const auto real = [&](std::size_t i) { return std::bit_cast<float>(get_word(p + 4 * i)); };
    sink(Attitude{get_word(p), real(1), real(2), real(3), real(4), real(5), real(6)});
  }

 private:
  PlainFrame frame_{};
  std::size_t size_ = 0;
  std::uint16_t crc_ = 0;
};

struct Encoding {
  std::vector<Attitude> messages;
  std::vector<FrameBuffer> buffers = std::vector<FrameBuffer>(kFrames);
  std::vector<PlainFrame> frames = std::vector<PlainFrame>(kFrames);
  Encoding() {
    for (int i = 0; i < kFrames; ++i) messages.push_back(attitude(i));
  }
  void ours() {
    Sender sender;
    for (std::size_t i = 0; i < kFrames; ++i) keep(encode(messages[i], sender, buffers[i]).data());
  }
  void other() {
    for (std::size_t i = 0; i < kFrames; ++i) {
      plain_encode(messages[i], static_cast<std::uint8_t>(i), frames[i]);
      keep(frames[i]);
    }
  }
  bool agree() {
    ours();
    other();
    for (std::size_t i = 0; i < kFrames; ++i)
      if (buffers[i].size() != kFrameBytes ||
          std::memcmp(buffers[i].data(), frames[i].data(), kFrameBytes) != 0)
        return false;
    return true;
  }
};

struct Parsing {
  std::vector<std::byte> stream;
  std::vector<Attitude> found;
  std::vector<Attitude> found_plainly;
  Parser parser;
  PlainParser plain;
  Parsing() {
    Sender sender;
    FrameBuffer buffer;
    for (int i = 0; i < kFrames; ++i) {
      const auto frame = encode(attitude(i), sender, buffer);
      stream.insert(stream.end(), frame.begin(), frame.end());
    }
    found.reserve(kFrames);
    found_plainly.reserve(kFrames);
  }
  void ours() {
    found.clear();
    parser.feed(stream, [&](const Frame& frame) {
      if (frame.id == Attitude::kId) found.push_back(decode<Attitude>(frame));
    });
    keep(found.data());
  }
  void other() {
    found_plainly.clear();
    for (const std::byte byte : stream)
      plain.feed(std::to_integer<std::uint8_t>(byte), [&](const Attitude& a) { found_plainly.push_back(a); });
    keep(found_plainly.data());
  }
  bool agree() {
    ours();
    other();
    return found.size() == kFrames &&
           std::equal(found.begin(), found.end(), found_plainly.begin(), found_plainly.end(),
                      [](const Attitude& a, const Attitude& b) { return values(a) == values(b); });
  }
};

template <class Contest>
Duel duel_of(const char* name, const char* peer) {
  const auto contest = std::make_shared<Contest>();
  return {.name = name,
          .unit = "frames/s",
          .peer = peer,
          .items = kFrames,
          .ours = [contest] { contest->ours(); },
          .other = [contest] { contest->other(); },
          .agree = [contest] { return contest->agree(); }};
}

}  // namespace

Duel mavlink_encode_duel() {
  return duel_of<Encoding>("MAVLink encode ATTITUDE", "shifts and a bitwise CRC");
}
Duel mavlink_parse_duel() { return duel_of<Parsing>("MAVLink parse ATTITUDE", "byte by byte, bitwise CRC"); }

}  // namespace forager::tools
