#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "hal/byte_stream.hpp"
#include "mocks/byte_ring.hpp"

namespace forager::mocks {

enum class MemoryStreamKind : std::uint8_t {
  bytes,      // like TCP or a serial line: order kept, borders between writes lost
  datagrams,  // like UDP: one write is one read; what nobody hears is lost
};

class MemoryStreamPair;

// One end of a MemoryStreamPair; made by it only.
class MemoryStream final : public hal::ByteStream {
 public:
  // The next call of this end that can fail answers this error, and the end is closed (as the contract says).
  void fail_next(hal::Error error) { next_error_ = std::move(error); }
  [[nodiscard]] hal::StreamState state() const { return state_; }

 private:
  friend class MemoryStreamPair;
  MemoryStream(MemoryStreamPair& pair, std::size_t capacity, std::string name)
      : pair_(&pair), inbox_(capacity), name_(std::move(name)) {}

  hal::Result<> do_open() override;
  hal::Result<hal::StreamState> do_poll() override;
  hal::Result<std::size_t> do_read(std::span<std::byte> into) override;
  hal::Result<std::size_t> do_write(std::span<const std::byte> bytes) override;
  void do_close() override;
  std::string_view do_name() const override { return name_; }
  hal::Result<> injected();
  hal::Result<> require_open(const char* operation) const;

  MemoryStreamPair* pair_;
  ByteRing inbox_;  // bytes on their way to this end
  std::string name_;
  hal::StreamState state_ = hal::StreamState::closed;
  bool listening_ = true;   // far end: connects are let in, until the device closes it
  bool peer_gone_ = false;  // this end is open, the other has hung up: drain, then "disconnected"
  std::optional<hal::Error> next_error_;
};

// Two connected ends of a line in memory. near() is the driver's: it dials with open() and poll(). far() is
// the device's: it listens from the start and is open while somebody is connected; the other members are the
// device's power over the line. Buffers are allocated once, here. Reads and writes allocate nothing.
//
// bytes: near connects at its next poll() unless connects are refused (refused), held (stays opening) or far
// was closed by the device (refused until far().open()). When one end closes, the other reads what is left
// and then "disconnected". A new connection starts with empty buffers.
// datagrams: both ends open at once and never see each other's state; a datagram for a closed end, or too
// big for the room left, is lost.
class MemoryStreamPair {
 public:
  MemoryStreamPair(const std::string& name, MemoryStreamKind kind, std::size_t capacity_bytes = 64 * 1024);
  MemoryStreamPair(const MemoryStreamPair&) = delete;
  MemoryStreamPair& operator=(const MemoryStreamPair&) = delete;

  [[nodiscard]] MemoryStream& near() { return near_; }
  [[nodiscard]] MemoryStream& far() { return far_; }

  [[nodiscard]] bool connected() const;
  [[nodiscard]] bool connecting() const { return near_.state_ == hal::StreamState::opening; }
  // Connections made so far: a change says that this is not the client from before.
  [[nodiscard]] std::uint32_t connections() const { return connections_; }

  // Hold: near stays "opening" until accept() (a network that drops the first packets, a busy server).
  void hold_connects(bool hold) { hold_ = hold; }
  // Lets a held client in. Errors: invalid_state (nobody is connecting).
  [[nodiscard]] hal::Result<> accept();
  // Nobody listens: near's poll() answers "refused".
  void refuse_connects(bool refuse) { refuse_ = refuse; }
  // Hangs up on the client; both ends go on as after a close by the peer. Bytes under way are delivered.
  void drop();
  // The cable is out, without either side noticing: bytes wait (datagrams are lost), connects wait.
  void cut(bool out) { cut_ = out; }
  // Back-pressure: at most this many unread bytes in each direction (never above the capacity).
  void limit_in_flight(std::size_t bytes) { limit_ = bytes; }

 private:
  friend class MemoryStream;
  [[nodiscard]] MemoryStream& other(const MemoryStream& end) { return &end == &near_ ? far_ : near_; }
  void connect();
  void hang_up(MemoryStream& end);

  MemoryStreamKind kind_;
  MemoryStream near_;
  MemoryStream far_;
  std::uint32_t connections_ = 0;
  std::size_t limit_;
  bool hold_ = false;
  bool refuse_ = false;
  bool cut_ = false;
};

}  // namespace forager::mocks
