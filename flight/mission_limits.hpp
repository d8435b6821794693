#pragma once

#include <optional>
#include <string_view>

#include "flight/mission.hpp"
#include "hal/time.hpp"

namespace forager::flight {

// How long a mission puts up with what. Every value is a choice of the scene or board file.
struct MissionLimits {
  hal::Duration start_timeout = std::chrono::seconds(60);     // links, mode, arming, each
  hal::Duration takeoff_timeout = std::chrono::seconds(30);   // to reach the height
  hal::Duration landing_timeout = std::chrono::seconds(120);  // then the mission ends without touch-down seen
  std::optional<hal::Duration> flight_time;                   // from take-off; empty: no limit
  double battery_reserve = 0.2;                               // 0..1 of a full battery
  hal::Duration reader_allowance = std::chrono::seconds(20);  // not reading for so long: land
  hal::Duration pose_allowance = std::chrono::seconds(2);     // no trustworthy pose for so long: land
  hal::Duration autopilot_allowance = std::chrono::seconds(30);  // silent for so long: the mission ends
  hal::Duration store_allowance = std::chrono::seconds(15);      // the inventory refuses for so long: land
};

// What the limits look at, in flight. `*_since` are set while the thing is wrong.
struct Vitals {
  hal::Instant now;
  std::optional<hal::Instant> airborne_since;
  bool halt_asked = false;
  bool autopilot_link_up = true;
  bool guided = true;
  bool armed = true;
  bool reader_failed = false;  // will not come back by itself
  std::optional<hal::Instant> reader_lost_since;
  std::optional<hal::Instant> pose_bad_since;
  std::optional<hal::Instant> store_failing_since;
  std::optional<double> battery_fraction;
};

// What must follow. Worst first: who has the vehicle counts more than whether it should land.
enum class Consequence : std::uint8_t {
  go_on,
  fall_silent,  // the autopilot is not there: command nothing, wait for it
  hands_off,    // the vehicle is somebody else's: command nothing any more
  land,
};
struct Verdict {
  Consequence consequence = Consequence::go_on;
  EndReason reason = EndReason::none;
  std::string_view detail;
};
[[nodiscard]] Verdict judge(const MissionLimits& limits, const Vitals& vitals);

}  // namespace forager::flight
