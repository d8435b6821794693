#pragma once

#include <cstdint>
#include <optional>

#include "flight/mavlink/mavlink_wire.hpp"
#include "flight/mavlink/signing.hpp"
#include "hal/time.hpp"

namespace forager::flight {

using namespace std::chrono_literals;

// Where on the globe the local origin is said to lie. Without GPS the autopilot will not arm before it knows.
struct GlobalOrigin {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double altitude_m = 0.0;
};

struct MavlinkSigningConfig {
  mavlink::SigningKey key{};
  std::uint8_t link_id = 0;
  std::uint64_t start_timestamp = 0;  // see mavlink::Signing
};

// How to talk to one ArduCopter 4.6. Every time is a choice of the board or scene file; these are starting
// values that fit a Pixhawk on a serial line or UDP.
struct MavlinkConfig {
  std::uint8_t sysid = 1;  // a companion shares the vehicle's system id
  std::uint8_t compid = mavlink::component::kOnboardComputer;
  // Not given: the first component 1 that says it is an autopilot.
  std::optional<std::uint8_t> target_sysid;
  std::optional<std::uint8_t> target_compid;
  std::uint32_t guided_mode = mavlink::copter_mode::kGuided;
  std::uint32_t land_mode = mavlink::copter_mode::kLand;

  hal::Duration heartbeat_interval = 1s;
  hal::Duration deadman = 500ms;       // without feed_deadman() for so long we fall silent
  hal::Duration link_timeout = 3s;     // no heartbeat for so long: the autopilot is gone
  hal::Duration pose_timeout = 500ms;  // position and attitude no older than this
  hal::Duration setpoint_interval = 100ms;
  hal::Duration attitude_interval = 20ms;  // of attitude and thrust
  hal::Duration vision_interval = 20ms;    // at least; ArduPilot drops what comes faster than 50 Hz

  hal::Duration command_timeout = 1s;  // until an unanswered command is sent again
  int command_tries = 5;
  hal::Duration command_progress_timeout = 10s;  // after the autopilot said "in progress"
  hal::Duration reason_timeout = 300ms;          // a refusal's STATUSTEXT may come this much after it

  hal::Duration pose_stream_interval = 50ms;  // LOCAL_POSITION_NED, ATTITUDE
  hal::Duration landed_stream_interval = 200ms;
  hal::Duration battery_stream_interval = 1s;
  std::optional<GlobalOrigin> origin;

  hal::Duration reopen_first = 250ms;        // pause before a failed stream is opened again; doubles
  hal::Duration reopen_most = 4s;            // up to this
  hal::Duration reopen_after_silence = 10s;  // an open stream without any byte is opened anew; zero: never

  std::optional<MavlinkSigningConfig> signing;
  bool journal_wire = false;  // also write all bytes to the journal
};

}  // namespace forager::flight
