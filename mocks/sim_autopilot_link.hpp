#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "hal/byte_stream.hpp"
#include "hal/journal.hpp"
#include "hal/random.hpp"
#include "hal/time.hpp"
#include "mocks/mavlink_peer.hpp"
#include "mocks/sim_autopilot_config.hpp"

namespace forager::mocks {

// The emulated autopilot's telemetry port: frames out, one write each, and frames in, with faults on both.
// What a serial line does not take at once waits in a buffer; a frame that finds the buffer full is lost
// whole, as in a real driver.
class SimAutopilotLink {
 public:
  SimAutopilotLink(hal::ByteStream& stream, const SimAutopilotConfig& config,
                   const SimAutopilotFaults& faults);

  // Bytes sent and heard go to the journal as "sim-autopilot"; null for none.
  void attach(hal::Journal* journal) { journal_ = journal; }
  // Opens the stream when it is closed, once in 100 ms, and sends what waits.
  void service(hal::Instant now);
  void send(const peer::MessageKind& kind, const MavlinkPayload& payload, hal::Instant now);
  // The next frame heard, valid until the next call, or nullptr.
  [[nodiscard]] const MavlinkPeerFrame* receive(hal::Instant now);
  void silent(bool silent) { silent_ = silent; }
  [[nodiscard]] std::uint64_t frames_sent() const { return frames_sent_; }
  [[nodiscard]] std::uint64_t frames_heard() const { return frames_heard_; }

 private:
  bool fill(hal::Instant now);
  void write(std::span<const std::byte> frame, hal::Instant now);

  hal::ByteStream* stream_;
  const SimAutopilotFaults* faults_;
  hal::Journal* journal_ = nullptr;
  MavlinkPeerPacker packer_;
  MavlinkPeerParser parser_;
  hal::Random random_;
  std::array<std::byte, 4096> waiting_{};
  std::size_t waiting_size_ = 0;
  std::array<std::byte, 2048> heard_{};  // a whole datagram
  std::size_t heard_begin_ = 0;
  std::size_t heard_end_ = 0;
  const MavlinkPeerFrame* again_ = nullptr;
  std::optional<hal::Instant> tried_;
  bool open_ = false;
  bool silent_ = false;
  std::uint64_t frames_sent_ = 0;
  std::uint64_t frames_heard_ = 0;
};

}  // namespace forager::mocks
