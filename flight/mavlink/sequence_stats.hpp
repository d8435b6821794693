#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "flight/mavlink/frame.hpp"

namespace forager::flight::mavlink {

struct PeerStats {
  std::uint8_t sysid = 0;
  std::uint8_t compid = 0;
  std::uint8_t next_sequence = 0;
  std::uint64_t frames = 0;
  std::uint64_t lost = 0;  // gaps in the sequence numbers, modulo 256 each

  [[nodiscard]] double loss_fraction() const {
    return frames + lost == 0 ? 0.0 : static_cast<double>(lost) / static_cast<double>(frames + lost);
  }
};

// Counts frames lost on one link, per sender (MAVLink packet loss). Means nothing behind a router that drops
// or merges streams. Room for 32 senders; frames of further ones are not counted.
class SequenceStats {
 public:
  void count(const Frame& frame);
  [[nodiscard]] std::span<const PeerStats> peers() const { return {peers_.data(), used_}; }
  // nullptr if that component was never heard.
  [[nodiscard]] const PeerStats* find(std::uint8_t sysid, std::uint8_t compid) const;

 private:
  std::array<PeerStats, 32> peers_{};
  std::size_t used_ = 0;
};

}  // namespace forager::flight::mavlink
