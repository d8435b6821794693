#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/byte_stream.hpp"
#include "hal/serial.hpp"
#include "mocks/byte_ring.hpp"

namespace forager::mocks {

// The serial side of an emulated USB adapter: two small memories between the USB and a line, which is any
// byte stream (one end of a MemoryStreamPair: the device under test has the other). The line is open while
// the host holds DTR, so that the far end sees a host come and go. Bytes for a far end that is not there are
// lost, as on a wire.
class SimUart {
 public:
  SimUart(hal::ByteStream& line, std::size_t received_bytes, std::size_t sending_bytes)
      : line_(&line), received_(received_bytes), sending_limit_(sending_bytes) {}

  void set_dtr(bool on);
  void clear_received() { received_.clear(); }
  void clear_sending() { sending_.clear(); }
  // Moves bytes between memories and line, as far as both have room.
  void pump();

  // What the host sees.
  [[nodiscard]] std::size_t waiting() const { return received_.size(); }
  std::size_t take(std::span<std::byte> into) { return received_.pop(into); }
  // All of it or nothing.
  [[nodiscard]] bool put(std::span<const std::byte> bytes);
  [[nodiscard]] bool sent() const { return sending_.empty(); }

 private:
  hal::ByteStream* line_;
  ByteRing received_;
  std::vector<std::byte> sending_;
  std::size_t sending_limit_;
  bool dtr_ = false;
};

}  // namespace forager::mocks
