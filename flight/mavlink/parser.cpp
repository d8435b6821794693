#include "flight/mavlink/parser.hpp"

#include <optional>

#include "flight/mavlink/crc.hpp"
#include "flight/mavlink/registry.hpp"

namespace forager::flight::mavlink {
namespace {

std::uint8_t u8(std::byte b) { return std::to_integer<std::uint8_t>(b); }

// The CRC_EXTRA with which a frame would be good, if there is one: the last step of the CRC is undone by a
// search, as the 256 possible outcomes all differ.
std::optional<std::uint8_t> implied_crc_extra(std::uint16_t crc_of_payload, std::uint16_t crc_sent) {
  for (unsigned extra = 0; extra < 256; ++extra)
    if (crc_add(crc_of_payload, static_cast<std::uint8_t>(extra)) == crc_sent)
      return static_cast<std::uint8_t>(extra);
  return std::nullopt;
}

}  // namespace

std::size_t Parser::take(std::span<const std::byte> bytes) {
  if (begin_ != 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  const std::size_t count = std::min(bytes.size(), buffer_.size() - end_);
  std::memcpy(buffer_.data() + end_, bytes.data(), count);
  end_ += count;
  return count;
}

bool Parser::next(Frame& frame) {
  while (begin_ != end_) {
    const std::uint8_t start = u8(buffer_[begin_]);
    if (start != kStxV1 && start != kStxV2) {
      skip_byte();
      continue;
    }
    switch (examine(frame)) {
      case Verdict::wait:
        return false;
      case Verdict::garbage:
        skip_byte();
        break;
      case Verdict::passed_over:
        begin_ += frame.bytes.size();
        break;
      case Verdict::good:
        begin_ += frame.bytes.size();
        ++stats_.frames;
        return true;
    }
  }
  return false;
}

Parser::Verdict Parser::examine(Frame& frame) {
  const std::byte* const p = buffer_.data() + begin_;
  const std::size_t available = end_ - begin_;
  const bool v1 = u8(p[0]) == kStxV1;
  const std::size_t header = v1 ? kHeaderV1 : kHeaderV2;
  if (available >= 3 && !v1 && (u8(p[2]) & ~kIncompatSigned) != 0) {
    ++stats_.incompatible;
    return Verdict::garbage;
  }
  if (available < header) return Verdict::wait;

  const std::size_t length = u8(p[1]);
  const bool is_signed = !v1 && u8(p[2]) == kIncompatSigned;
  const std::size_t crc_at = header + length;
  const std::size_t total = crc_at + kCrcSize + (is_signed ? kSignatureSize : 0);
  if (available < total) return Verdict::wait;

  if (v1)
    frame = {Version::v1, 0, 0, u8(p[2]), u8(p[3]), u8(p[4]), u8(p[5]), {}, {}};
  else
    frame = {Version::v2,
             u8(p[2]),
             u8(p[3]),
             u8(p[4]),
             u8(p[5]),
             u8(p[6]),
             u8(p[7]) | std::uint32_t{u8(p[8])} << 8U | std::uint32_t{u8(p[9])} << 16U,
             {},
             {}};
  frame.payload = {p + header, length};
  frame.bytes = {p, total};

  const std::uint16_t crc = crc_add(kCrcStart, std::span(p + 1, crc_at - 1));
  const auto crc_sent = static_cast<std::uint16_t>(u8(p[crc_at]) | u8(p[crc_at + 1]) << 8U);
  const MessageInfo* const info = find_message(frame.id);
  if (info == nullptr) return examine_unknown(frame.id, crc, crc_sent);
  if (crc_add(crc, info->crc_extra) == crc_sent) return Verdict::good;
  ++stats_.bad_crc;
  return Verdict::garbage;
}

Parser::Verdict Parser::examine_unknown(std::uint32_t id, std::uint16_t crc_of_payload,
                                        std::uint16_t crc_sent) {
  const auto known = std::ranges::find_if(learnt_, [&](const Learnt& l) { return l.seen > 0 && l.id == id; });
  if (known != learnt_.end() && crc_add(crc_of_payload, known->crc_extra) == crc_sent) {
    ++stats_.unknown;
    known->seen = 2;
    return Verdict::passed_over;
  }
  const auto extra = implied_crc_extra(crc_of_payload, crc_sent);
  if (!extra) return Verdict::garbage;
  if (known == learnt_.end()) {
    ++stats_.unknown;
    learnt_[next_learnt_] = {id, *extra, 1};
    next_learnt_ = (next_learnt_ + 1) % learnt_.size();
  } else if (known->seen == 1) {
    known->crc_extra = *extra;  // one of the two was a coincidence; the next frame tells
  } else {
    ++stats_.bad_crc;
  }
  return Verdict::garbage;
}

}  // namespace forager::flight::mavlink
