#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "hal/pose.hpp"
#include "hal/time.hpp"

namespace forager::flight {

// What a navigation step decided, with the letters of the published figures.
enum class DecisionKind : std::uint8_t {
  forward,     // F: go on along the present heading
  turn_left,   // TL
  turn_right,  // TR
  turn_back,   // TB
  stay,        // S: keep listening here (a try, or tags still arrive at a blocked heading)
  land,        // L
};
[[nodiscard]] std::string_view to_string(DecisionKind kind);  // "F", "TL", "TR", "TB", "S", "L"

enum class EndReason : std::uint8_t {
  none,
  no_new_tags,     // n_tries windows in a row without a new tag
  path_complete,   // a fixed path was flown to its end
  time_limit,      // the mission's flight-time limit
  battery,         // the autopilot reported less than the reserve
  reader_lost,     // the reader did not come back within its allowance
  pose_lost,       // localisation failed: landing on the autopilot's own estimate
  autopilot_lost,  // no heartbeat from the autopilot
  store_failed,    // the inventory cannot be stored any more
  autopilot_mode,  // somebody took the vehicle out of GUIDED: it is theirs now
  refused,         // arming or take-off refused; never left the ground
  halted,          // asked to stop (signal, operator)
};
[[nodiscard]] std::string_view to_string(EndReason reason);  // "no_new_tags"

// One decision with everything that led to it, for the journal, the report and the tests.
struct Decision {
  hal::Instant at;
  DecisionKind kind = DecisionKind::stay;
  hal::Pose from;              // where it was taken, world frame
  double heading_rad = 0.0;    // heading chosen, world frame, (-pi, pi]
  double step_m = 0.0;         // distance to go along it; 0 for turns in place
  std::uint32_t new_tags = 0;  // new tags of the window it rests on
};

}  // namespace forager::flight
