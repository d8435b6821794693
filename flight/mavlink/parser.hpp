#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>

#include "flight/mavlink/frame.hpp"

namespace forager::flight::mavlink {

struct ParserStats {
  std::uint64_t bytes = 0;          // fed
  std::uint64_t frames = 0;         // known id, good CRC: handed out
  std::uint64_t unknown = 0;        // frames of ids not known here, passed over
  std::uint64_t bad_crc = 0;        // looked like the start of a known frame, but the CRC disagrees
  std::uint64_t incompatible = 0;   // incompat_flags beyond "signed": must be discarded
  std::uint64_t skipped_bytes = 0;  // belonged to no frame
};

// Finds MAVLink 1 and 2 frames in a stream of bytes, cut anywhere. Never allocates. After a start byte that
// led nowhere it goes on with the very next byte, so garbage cannot swallow a good frame behind its start.
//
// A frame of an unknown id cannot be checked, as its CRC_EXTRA is unknown; but its CRC says which CRC_EXTRA
// would make it good, if any (one in 256 random frames has one). An id that twice implies the same one is
// believed and its frames passed over whole; before that their inside is searched like garbage.
class Parser {
 public:
  // Calls sink(const Frame&) for every good frame that `bytes` completes.
  template <class Sink>
  void feed(std::span<const std::byte> bytes, Sink&& sink) {
    stats_.bytes += bytes.size();
    while (!bytes.empty()) {
      bytes = bytes.subspan(take(bytes));
      Frame frame;
      while (next(frame)) sink(std::as_const(frame));
    }
  }

  // Gives up waiting for the rest of a frame that has begun, and searches what came after its start byte. For
  // a line that fell silent: a stray start byte may announce 255 bytes that will not come for a long time.
  template <class Sink>
  void flush(Sink&& sink) {
    while (begin_ != end_) {
      skip_byte();
      Frame frame;
      while (next(frame)) sink(std::as_const(frame));
    }
  }

  [[nodiscard]] bool has_partial_frame() const { return begin_ != end_; }
  [[nodiscard]] const ParserStats& stats() const { return stats_; }

  // Forgets a partial frame, for a stream that was opened anew; the counters stay.
  void reset() { begin_ = end_ = 0; }

 private:
  struct Learnt {
    std::uint32_t id = 0;
    std::uint8_t crc_extra = 0;
    std::uint8_t seen = 0;  // 0: slot unused
  };

  std::size_t take(std::span<const std::byte> bytes);
  bool next(Frame& frame);
  enum class Verdict : std::uint8_t { wait, garbage, passed_over, good };
  Verdict examine(Frame& frame);
  Verdict examine_unknown(std::uint32_t id, std::uint16_t crc_of_payload, std::uint16_t crc_sent);
  void skip_byte() {
    ++begin_;
    ++stats_.skipped_bytes;
  }

  std::array<std::byte, 4 * kMaxFrame> buffer_;  // only [begin_, end_) is ever read
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::array<Learnt, 32> learnt_{};
  std::size_t next_learnt_ = 0;
  ParserStats stats_;
};

}  // namespace forager::flight::mavlink
