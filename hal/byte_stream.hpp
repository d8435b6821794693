#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "hal/error.hpp"

namespace forager::hal {

enum class StreamState : std::uint8_t { closed, opening, open };

// Bytes to and from one peer: a TCP connection, a UDP peer, a serial line. Never blocks: every call returns
// at once and the caller tries again at its next update. For a datagram peer one write is one datagram and
// one read returns at most one; a reader must offer room for the largest.
//
// Life: closed -> open() -> opening -> (poll) -> open -> close() or a failure -> closed. After any error
// other than invalid_state the stream is closed; open() starts again. Reconnecting is the driver's business,
// not the stream's.
class ByteStream {
 public:
  virtual ~ByteStream() = default;

  // Starts to connect. Errors: invalid_state (not closed), not_present (name does not resolve), permission,
  // busy (somebody holds the line), unsupported, io.
  [[nodiscard]] Result<> open() { return do_open(); }

  // Drives a pending connect and says how things stand. Errors: refused (nobody listens), timeout (the
  // network gave up), disconnected, io.
  [[nodiscard]] Result<StreamState> poll() { return do_poll(); }

  // Up to into.size() bytes; 0 means nothing is there now. Errors: invalid_state (not open), disconnected
  // (the peer closed, the cable is out), io. Bytes that arrived before a close are delivered before the
  // error.
  [[nodiscard]] Result<std::size_t> read(std::span<std::byte> into) { return do_read(into); }

  // As many bytes as fit now, possibly 0. Errors as read().
  [[nodiscard]] Result<std::size_t> write(std::span<const std::byte> bytes) { return do_write(bytes); }

  void close() { do_close(); }

  // What a person calls it: "tcp 192.168.1.50:3177".
  [[nodiscard]] std::string_view name() const { return do_name(); }

 private:
  virtual Result<> do_open() = 0;
  virtual Result<StreamState> do_poll() = 0;
  virtual Result<std::size_t> do_read(std::span<std::byte> into) = 0;
  virtual Result<std::size_t> do_write(std::span<const std::byte> bytes) = 0;
  virtual void do_close() = 0;
  virtual std::string_view do_name() const = 0;
};

}  // namespace forager::hal
