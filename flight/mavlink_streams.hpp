#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "flight/mavlink/messages_command.hpp"
#include "flight/mavlink_config.hpp"

namespace forager::flight {

// Sees to it that the autopilot sends what we need: ArduPilot streams nothing but HEARTBEAT and TIMESYNC
// until asked, and forgets when it reboots. A message that does not come is asked for again, less and less
// often.
class MavlinkStreams {
 public:
  explicit MavlinkStreams(const MavlinkConfig& config);

  void heard(std::uint32_t id, hal::Instant now);
  // The link is up, or up again: everything is asked for anew.
  void restart();
  // The next SET_MESSAGE_INTERVAL to send, at most one per call, or nullopt. Targets are left 0.
  [[nodiscard]] std::optional<mavlink::CommandLong> due(hal::Instant now);

 private:
  struct Stream {
    std::uint32_t id = 0;
    hal::Duration interval{};
    hal::Instant last_heard{};
    hal::Instant next_ask{};
    hal::Duration pause{};  // zero: never asked
  };
  std::array<Stream, 5> streams_;
};

}  // namespace forager::flight
