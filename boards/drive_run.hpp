#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "boards/drive_scene.hpp"
#include "flight/drive_loop.hpp"
#include "hal/journal.hpp"

namespace forager::boards {

enum class DriveFault : std::uint8_t {
  none,
  left_stuck_here,  // the servo stays where it is
  right_stuck_here,
  left_stuck_locked,
  right_stuck_locked,
  left_open,  // the pad never touches again
  right_open,
  pose_lost,       // samples without confidence
  pose_silent,     // no samples
  link_lost,       // the autopilot's line is cut, both ways
  command_stale,   // the mission stops renewing its command
  watch_lost,      // nobody feeds the dead-man any more
  process_killed,  // nothing of ours runs any more
  slippery,        // a floor on which locked wheels slide
  motors_dead,     // all ESCs
  one_motor_dead,  // one of four: less thrust, beside the middle
  stop_button,     // emergency stop on a pin
  stop_link,       // emergency stop over MAVLink
};
inline constexpr std::size_t kDriveFaults = 18;
[[nodiscard]] std::string_view to_string(DriveFault fault);

struct DriveRunOptions {
  std::uint64_t seed = 1;
  DriveFault fault = DriveFault::none;
  double fault_s = 0.0;  // from when on it may strike; it does as soon as the vehicle moves then
  bool wire = false;     // through MAVLink bytes and servo pulses instead of calls
  bool keep_track = false;
  hal::Journal* journal = nullptr;  // may be null
};

// Where it truly was; for reports.
struct DriveTrack {
  double at_s = 0.0;
  double x = 0.0;
  double y = 0.0;
  double yaw_rad = 0.0;
};

// One run, judged by the truth and not by what the vehicle believed.
struct DriveResult {
  std::uint64_t seed = 0;
  flight::DriveEnd end = flight::DriveEnd::none;
  std::string detail;
  double position_error_m = 0.0;
  double heading_error_rad = 0.0;
  double time_s = 0.0;
  std::size_t steps = 0;  // of the path
  std::size_t steps_done = 0;
  servo::SteerStats stats;
  servo::SteerLearnt learnt;
  double corridor_m = 0.0;        // farthest from its path
  bool left_corridor = false;     // and was out of the corridor
  bool out_without_stop = false;  // ... while it still pushed 300 ms later
  double clearance_m = 0.0;       // least, between body and obstacles; negative: contact
  double energy_in_j = 0.0;       // work of the thrust
  double thrust_n_s = 0.0;        // thrust times time: what the battery feels
  bool hung = false;              // the time limit of the scene ended it

  DriveFault fault = DriveFault::none;
  std::optional<double> struck_s;    // the fault came
  std::optional<double> detected_s;  // it was noticed: no more thrust was allowed
  std::optional<double> safe_s;      // thrust gone and every working brake grips, or it stands
  double moved_after_m = 0.0;        // from detection until it stood
  double turned_after_rad = 0.0;
  bool stands = false;            // at the end
  std::vector<DriveTrack> track;  // kept on request

  [[nodiscard]] bool arrived(const DriveScene& scene) const;
  // From detection to safe; nothing if it was not detected or never safe.
  [[nodiscard]] std::optional<double> reaction_s() const;
};

// Runs one drive to its end and until the vehicle stands. Errors: those of path_steps and of the devices.
[[nodiscard]] hal::Result<DriveResult> run_drive(const DriveScene& scene, const DriveRunOptions& options);

// Path to steps and corridor, as run_drive() does it. Errors: those of path_steps.
[[nodiscard]] hal::Result<flight::DriveMission> drive_mission(const DriveScene& scene);

}  // namespace forager::boards
