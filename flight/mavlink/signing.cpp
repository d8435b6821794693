#include "flight/mavlink/signing.hpp"

#include <algorithm>

#include "flight/mavlink/messages_link.hpp"

namespace forager::flight::mavlink {
namespace {

constexpr std::size_t kHashSize = 6;
constexpr std::size_t kTimestampSize = 6;
constexpr hal::Duration kUnit = std::chrono::microseconds(10);

std::uint64_t read_timestamp(const std::byte* at) {
  std::uint64_t value = 0;
  for (std::size_t i = kTimestampSize; i-- > 0;) value = value << 8U | std::to_integer<std::uint64_t>(at[i]);
  return value;
}

}  // namespace

std::uint64_t signing_timestamp(hal::Duration since_unix_epoch) {
  const hal::Duration since_2015 = since_unix_epoch - std::chrono::seconds(kSigningEpochUnixSeconds);
  return since_2015 <= hal::Duration::zero() ? 0 : static_cast<std::uint64_t>(since_2015 / kUnit);
}

hal::Result<Signing> Signing::create(const SigningKey& key, std::uint8_t link_id,
                                     std::uint64_t start_timestamp, hal::Instant now) {
  auto sha = Sha256::create();
  if (!sha) return hal::fail(std::move(sha).error());
  return Signing(key, link_id, start_timestamp, now, std::move(*sha));
}

Signing::Signing(const SigningKey& key, std::uint8_t link_id, std::uint64_t start_timestamp, hal::Instant now,
                 Sha256 sha)
    : key_(key),
      link_id_(link_id),
      timestamp_(start_timestamp),
      clock_start_(now),
      clock_base_(start_timestamp),
      sha_(std::move(sha)) {}

void Signing::advance(hal::Instant now) {
  const auto elapsed = std::max(hal::Duration::zero(), now - clock_start_);
  timestamp_ = std::max(timestamp_, clock_base_ + static_cast<std::uint64_t>(elapsed / kUnit));
}

hal::Result<> Signing::sign(FrameBuffer& frame, hal::Instant now) {
  std::byte* const p = frame.data();
  const std::size_t end = frame.size();
  if (end < kHeaderV2 + kCrcSize || p[0] != std::byte{kStxV2} || p[2] != std::byte{kIncompatSigned})
    return hal::fail(hal::ErrorCode::invalid_argument, "MAVLink signing", "sign a frame",
                     "it is not a MAVLink 2 frame encoded to be signed");
  const std::uint64_t before = timestamp_;
  advance(now);
  timestamp_ = std::max(timestamp_, before + 1);

  p[end] = std::byte{link_id_};
  for (std::size_t i = 0; i < kTimestampSize; ++i)
    p[end + 1 + i] = std::byte((timestamp_ >> (8 * i)) & 0xFFU);
  const std::size_t hash_at = end + 1 + kTimestampSize;
  const auto digest = sha_.digest(key_, {p, hash_at});
  if (!digest) return hal::fail(digest.error());
  std::copy_n(digest->data(), kHashSize, p + hash_at);
  frame.set_size(hash_at + kHashSize);
  return {};
}

hal::Result<SignatureVerdict> Signing::verify(const Frame& frame, hal::Instant now) {
  if (!frame.is_signed())
    return frame.id == RadioStatus::kId ? SignatureVerdict::exempt : SignatureVerdict::not_signed;
  const std::size_t hash_at = frame.bytes.size() - kHashSize;
  const std::byte* const signature = frame.bytes.data() + frame.bytes.size() - kSignatureSize;
  const auto link_id = std::to_integer<std::uint8_t>(signature[0]);
  const std::uint64_t timestamp = read_timestamp(signature + 1);

  const auto digest = sha_.digest(key_, frame.bytes.first(hash_at));
  if (!digest) return hal::fail(digest.error());
  unsigned difference = 0;  // gathered over all bytes: the time taken says nothing about where they differ
  for (std::size_t i = 0; i < kHashSize; ++i)
    difference |= std::to_integer<unsigned>((*digest)[i] ^ frame.bytes[hash_at + i]);
  if (difference != 0) return SignatureVerdict::wrong_hash;

  advance(now);
  if (Stream* const stream = find_stream(frame, link_id)) {
    if (timestamp <= stream->last_timestamp) return SignatureVerdict::replayed;
    stream->last_timestamp = timestamp;
  } else {
    if (timestamp + kSigningMaxAge < timestamp_) return SignatureVerdict::too_old;
    if (used_ == streams_.size()) return SignatureVerdict::too_many_streams;
    streams_[used_++] = {frame.sysid, frame.compid, link_id, timestamp};
  }
  timestamp_ = std::max(timestamp_, timestamp);
  return SignatureVerdict::good;
}

Signing::Stream* Signing::find_stream(const Frame& frame, std::uint8_t link_id) {
  for (std::size_t i = 0; i < used_; ++i) {
    Stream& stream = streams_[i];
    if (stream.sysid == frame.sysid && stream.compid == frame.compid && stream.link_id == link_id)
      return &stream;
  }
  return nullptr;
}

}  // namespace forager::flight::mavlink
