#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "flight/mission.hpp"
#include "flight/obstacle_guard.hpp"
#include "hal/pose.hpp"
#include "hal/time.hpp"
#include "reader/new_tag_counter.hpp"

namespace forager::flight {

// What a policy knows when a listening window has closed. World frame REP-103.
struct Observation {
  hal::Instant now;
  hal::Duration elapsed{};  // since the first window opened
  hal::Pose pose_world;
  std::span<const reader::PortWeight>
      weights;                           // new tags per antenna in the window; bearings in the body frame
  std::uint32_t new_tags = 0;            // in the window, with those of windows that were taken back
  std::uint32_t fresh_tags = 0;          // first heard since the last decision, on the way or in the window
  std::uint32_t tries = 0;               // windows in a row, this one included, that brought nothing fresh
  WayAhead way_ahead = WayAhead::blind;  // along the present heading, now
  bool blocked = false;      // the last step was not taken, or cut short, because the way was not free
  double moved_m = 0.0;      // way made since the last decision
  std::uint32_t window = 0;  // running number of the window, from 1
};

// What to do next: turn to a heading, go a way along it if the guard lets it, then listen.
struct Step {
  DecisionKind kind = DecisionKind::stay;
  double heading_rad = 0.0;         // world frame, (-pi, pi]; for stay the present heading
  double length_m = 0.0;            // 0: only turn, or stay
  double height_m = 0.0;            // height above the take-off plane to be flown at from now on
  double speed_m_s = 0.0;           // of the way; 0: the loop's
  bool consume_tags = true;         // false: no decision came of the window, its tags stay new
  hal::Duration listen{};           // length of the next window; 0: decide again on arrival
  EndReason end = EndReason::none;  // why, when kind is land
};

// Decides where an inventory mission goes. Deterministic: equal observations give equal steps (the random
// walk carries its own seeded generator). Knows neither reader nor autopilot.
class Policy {
 public:
  virtual ~Policy() = default;
  // Called once, when the vehicle hovers at its start: where it is, and the first window to listen for.
  virtual Step begin(const hal::Pose& pose_world) = 0;
  virtual Step decide(const Observation& seen) = 0;
  [[nodiscard]] virtual std::string_view name() const = 0;
};

// Letter of a turn: forward within 45 degrees, back beyond 135, left or right between.
[[nodiscard]] DecisionKind kind_of_turn(double turn_rad);

// A step to a heading, with its letter; stay in place, with the height and window left to the caller.
[[nodiscard]] Step step_along(double heading_rad, double length_m, const hal::Pose& from);
[[nodiscard]] Step stay_at(const hal::Pose& from);
[[nodiscard]] Step land_now(const hal::Pose& from, EndReason why);

}  // namespace forager::flight
