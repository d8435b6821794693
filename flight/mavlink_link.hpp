#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "flight/mavlink/codec.hpp"
#include "flight/mavlink/parser.hpp"
#include "flight/mavlink/sequence_stats.hpp"
#include "flight/mavlink/signing.hpp"
#include "flight/mavlink_config.hpp"
#include "hal/byte_stream.hpp"
#include "hal/journal.hpp"

namespace forager::flight {

struct MavlinkLinkStats {
  std::uint64_t frames_sent = 0;
  std::uint64_t frames_dropped = 0;      // stream closed, or too slow for us
  std::uint64_t frames_unauthentic = 0;  // not signed as they must be
  std::uint64_t opens = 0;
};

// MAVLink frames over one byte stream (serial line, UDP or TCP peer): opens it, opens it again after failures
// with growing pauses, signs and checks signatures when there is a key.
class MavlinkLink {
 public:
  MavlinkLink(hal::ByteStream& stream, hal::Journal& journal, const MavlinkConfig& config,
              std::optional<mavlink::Signing> signing);

  // Opens, polls, and sends what the stream did not take before.
  void service(hal::Instant now);

  // Calls sink(const mavlink::Frame&) for every good frame that has come.
  template <class Sink>
  void receive(hal::Instant now, Sink&& sink) {
    std::array<std::byte, 2048> bytes;  // more than any datagram of MAVLink; written before it is read
    const auto pass = [&](const mavlink::Frame& frame) {
      if (admit(frame, now)) sink(frame);
    };
    for (int reads = 0; reads < kMaxReads; ++reads) {
      const std::size_t count = read(bytes, now);
      if (count == 0) break;
      parser_.feed(std::span(bytes).first(count), pass);
    }
    if (parser_.has_partial_frame() && now - last_byte_ > kQuiet) parser_.flush(pass);
  }

  // Sends at once. A frame for a closed stream, or for one that does not keep up, is dropped and counted.
  template <mavlink::Message M>
  void send(const M& message, hal::Instant now) {
    mavlink::FrameBuffer buffer;
    mavlink::encode(message, sender_, buffer, signing_ ? mavlink::kIncompatSigned : std::uint8_t{0});
    transmit(buffer, now);
  }

  [[nodiscard]] bool is_open() const { return state_ == hal::StreamState::open; }
  [[nodiscard]] const MavlinkLinkStats& stats() const { return stats_; }
  [[nodiscard]] const mavlink::ParserStats& parser_stats() const { return parser_.stats(); }
  [[nodiscard]] const mavlink::SequenceStats& sequence_stats() const { return sequences_; }

 private:
  static constexpr int kMaxReads = 64;  // per update, so that a flood cannot hold up the loop
  static constexpr hal::Duration kQuiet = std::chrono::milliseconds(100);

  std::size_t read(std::span<std::byte> into, hal::Instant now);
  bool admit(const mavlink::Frame& frame, hal::Instant now);
  void transmit(mavlink::FrameBuffer& buffer, hal::Instant now);
  void flush(hal::Instant now);
  void opened(hal::Instant now);
  void failed(const hal::Error& error, hal::Instant now);

  hal::ByteStream* stream_;
  hal::Journal* journal_;
  bool journal_wire_;
  std::uint8_t sysid_;
  std::uint8_t compid_;
  hal::Duration reopen_first_;
  hal::Duration reopen_most_;
  hal::Duration reopen_after_silence_;
  std::optional<mavlink::Signing> signing_;
  mavlink::Sender sender_;
  mavlink::Parser parser_;
  mavlink::SequenceStats sequences_;
  MavlinkLinkStats stats_;

  hal::StreamState state_ = hal::StreamState::closed;
  hal::Duration pause_;
  std::optional<hal::Instant> next_open_;
  hal::Instant last_byte_{};
  std::array<std::byte, 2048> waiting_{};  // taken by us, not yet by the stream
  std::size_t waiting_size_ = 0;
};

}  // namespace forager::flight
