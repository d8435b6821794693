#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "hal/error.hpp"
#include "reader/advannet_wire.hpp"

namespace forager::reader {

// Every byte that came in is in exactly one of frame_bytes, blank_bytes, garbage_bytes, or still pending.
struct AdvanNetStreamCounters {
  std::uint64_t bytes = 0;          // handed in
  std::uint64_t frames = 0;         // complete, with a body
  std::uint64_t keepalives = 0;     // complete, without a body
  std::uint64_t frame_bytes = 0;    // headers and bodies of both
  std::uint64_t blank_bytes = 0;    // empty lines between frames
  std::uint64_t garbage_lines = 0;  // lines between frames that start no frame
  std::uint64_t bad_headers = 0;    // started like a frame, but gave no usable length
  std::uint64_t garbage_bytes = 0;  // of both
};

// Cuts the AdvanNet event stream into message bodies. A frame is
//     ADVANNET/1.1 CRLF  Content-Length:123 CRLF  Content-Type:text/xml CRLF  CRLF  <123 bytes>
// and firmware, vendor clients and captures differ in the rest, so this accepts any version, header names in
// any case and any order, blanks around values, a missing CR, any number of empty lines between frames, and
// keep-alives (length 0) with or without a content type. What starts no frame is skipped to the end of its
// line and counted. Where the bytes are cut on their way makes no difference to any result.
//
// Bytes go into a buffer of the parser: write into room(), say how many with commit(), take bodies with
// next() until it has none. The buffer grows to the largest frame seen, then nothing allocates any more.
class AdvanNetStream {
 public:
  explicit AdvanNetStream(std::size_t max_body_bytes = advannet::kMaxFrameBytes);

  // Where the next bytes go; never empty. Call next() until it has nothing before asking again. Invalidates
  // the last body.
  [[nodiscard]] std::span<std::byte> room();
  void commit(std::size_t count);

  // The next body, or nullopt when more bytes are needed. Valid until the next room() or reset(). Errors:
  // protocol (a length above the cap: either not an AdvanNet stream or a hostile one); it stays until
  // reset().
  [[nodiscard]] hal::Result<std::optional<std::string_view>> next();

  // Forgets a half-received frame, for a new connection. Counters go on.
  void reset();

  [[nodiscard]] const AdvanNetStreamCounters& counters() const { return counters_; }
  [[nodiscard]] std::size_t pending_bytes() const { return end_ - begin_; }

 private:
  enum class State : std::uint8_t { seek, header, body, broken };
  struct Line {
    std::string_view text;  // without its end
    std::size_t size = 0;   // with its end
  };
  [[nodiscard]] std::string_view pending() const;
  [[nodiscard]] std::optional<Line> take_line();
  void seek_line(const Line& line);
  void header_line(const Line& line);
  void start_header(const Line& line);
  void give_up_header();

  std::vector<std::byte> buffer_;
  std::size_t begin_ = 0;  // first byte not yet consumed
  std::size_t end_ = 0;    // behind the last byte received
  std::size_t max_body_;
  State state_ = State::seek;
  bool in_long_line_ = false;  // inside a garbage line longer than any header
  std::size_t header_bytes_ = 0;
  std::size_t header_lines_ = 0;
  std::optional<std::uint64_t> length_;
  bool length_bad_ = false;
  AdvanNetStreamCounters counters_;
};

}  // namespace forager::reader
