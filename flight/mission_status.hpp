#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "flight/mission.hpp"
#include "flight/read_intake.hpp"
#include "hal/pose.hpp"
#include "hal/time.hpp"

namespace forager::flight {

enum class MissionPhase : std::uint8_t {
  waiting,    // for reader, autopilot and localisation
  guided,     // asked for GUIDED
  arming,     // asked to arm
  takeoff,    // asked to take off, climbing
  listening,  // a window is open
  stepping,   // turning, looking, going
  landing,    // asked to land, or landing
  silent,     // the autopilot is gone: neither heartbeat nor command is sent
  storing,    // down; the last reads go into the inventory
  done,
};
[[nodiscard]] std::string_view to_string(MissionPhase phase);  // "listening"

// Where the vehicle was, thinned to be drawn: a pose every so many metres, the distance doubling each time
// the room is used up. Never allocates after construction.
class FlownPath {
 public:
  explicit FlownPath(std::size_t capacity = 4096, double spacing_m = 0.1)
      : capacity_(capacity < 2 ? 2 : capacity), spacing_m_(spacing_m) {
    points_.reserve(capacity_);
  }
  struct Point {
    hal::Instant at;
    hal::Pose pose_world;
  };
  void add(hal::Instant now, const hal::Pose& pose_world);
  [[nodiscard]] std::span<const Point> points() const { return points_; }
  [[nodiscard]] double length_m() const { return length_m_; }  // horizontal, of the poses given

 private:
  std::size_t capacity_;
  double spacing_m_;
  double length_m_ = 0.0;
  std::optional<hal::Vec3> counted_to_;
  std::vector<Point> points_;
};

// How a mission stands. Written by the robot loop, read by whoever watches.
struct MissionStatus {
  MissionPhase phase = MissionPhase::waiting;
  hal::Instant phase_since;
  std::optional<hal::Instant> took_off;  // take-off asked for
  std::optional<hal::Instant> touched_down;
  std::optional<hal::Pose> pose_world;
  std::uint64_t reads = 0;      // tag reads taken in, with the reader's own folding
  std::size_t unique_tags = 0;  // different tags, up to the last closed window
  std::uint32_t window = 0;     // running number of the present window
  std::uint32_t tries = 0;      // windows in a row without a new tag
  double path_m = 0.0;
  std::optional<double> battery_fraction;
  EndReason end = EndReason::none;
  std::string detail;  // why it ended, or what it waits for
  std::vector<Decision> decisions;
};

}  // namespace forager::flight
