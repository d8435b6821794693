#include "flight/mavlink/sequence_stats.hpp"

namespace forager::flight::mavlink {

const PeerStats* SequenceStats::find(std::uint8_t sysid, std::uint8_t compid) const {
  for (const PeerStats& peer : peers())
    if (peer.sysid == sysid && peer.compid == compid) return &peer;
  return nullptr;
}

void SequenceStats::count(const Frame& frame) {
  for (std::size_t i = 0; i < used_; ++i) {
    PeerStats& peer = peers_[i];
    if (peer.sysid != frame.sysid || peer.compid != frame.compid) continue;
    peer.lost += static_cast<std::uint8_t>(frame.sequence - peer.next_sequence);
    peer.next_sequence = static_cast<std::uint8_t>(frame.sequence + 1);
    ++peer.frames;
    return;
  }
  if (used_ < peers_.size())
    peers_[used_++] = {frame.sysid, frame.compid, static_cast<std::uint8_t>(frame.sequence + 1), 1, 0};
}

}  // namespace forager::flight::mavlink
