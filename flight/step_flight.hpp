#pragma once

#include <cstdint>

#include "flight/autopilot.hpp"
#include "flight/obstacle_guard.hpp"
#include "flight/policy.hpp"
#include "hal/pose.hpp"
#include "hal/time.hpp"

namespace forager::flight {

struct StepFlightConfig {
  double speed_m_s = 0.5;         // of the way, unless the step says otherwise
  double arrival_m = 0.2;         // per axis
  double arrival_yaw_rad = 0.26;  // 15 degrees
  double aligned_rad = 0.09;      // 5 degrees: as straight as it must look before it goes
  double lead_m = 1.0;            // the goal runs no further ahead of the body than this
  double braking_m_s2 = 1.0;      // for where to stop; gentle is safe, the goal is only a place to hold
  hal::Duration look_timeout = std::chrono::seconds(1);  // for a frame taken after the turn
  hal::Duration slack = std::chrono::seconds(5);         // of the time limits for turns and ways
  hal::Duration setpoint_validity = std::chrono::milliseconds(500);
};

enum class StepOutcome : std::uint8_t {
  flying,   // under way
  arrived,  // there, within the tolerances
  blocked,  // not begun, or cut short: the way is not free, or cannot be seen
  late,     // not there within the time limit; holds where it is
};

// Flies one step of a policy: turn in place (and change height), look, go forward, arrive; then hold.
//
//   turning    yaw and height to the goal        -> looking when aligned; arrived if there is no way to go;
//                                                   late when it takes too long
//   looking    waits for a frame taken since     -> advancing if clear; blocked if blocked, or blind for long
//   advancing  the goal runs ahead at the speed  -> arrived; stopping as soon as the way is not clear, or the
//                                                   heading leaves it by more than arrival_yaw; late
//   stopping   holds the place it can stop at    -> blocked when it has come to rest
//   holding    keeps place, height and heading   -> (the next step)
//
// Forward only: the goal moves along the heading that the camera looks along, sideways never.
class StepFlight {
 public:
  explicit StepFlight(const StepFlightConfig& config) : config_(config) {}

  // Keeps this pose from now on.
  void hold(const hal::Pose& pose_world);
  // floor_z_m: height of the take-off plane in the world frame, to which the step's height is added.
  void begin(const Step& step, const hal::Pose& pose_world, double floor_z_m, hal::Instant now);
  // velocity_world: for where it can stop. way: the guard's verdict along the present heading.
  StepOutcome update(const hal::Pose& pose_world, hal::Vec3 velocity_world_m_s, const GuardVerdict& way,
                     hal::Instant now);

  // The goal in force.
  [[nodiscard]] PositionSetpoint setpoint(hal::Instant now) const;
  // Whether depth frames matter now.
  [[nodiscard]] bool watching() const { return stage_ != Stage::holding && length_m_ > 0.0; }
  [[nodiscard]] double planned_speed_m_s() const { return watching() ? speed_m_s_ : 0.0; }
  // Whether the last step turned, raised or moved the body, and how far it went.
  [[nodiscard]] bool changed_pose() const { return turned_ || moved_m_ > config_.arrival_m; }
  [[nodiscard]] double moved_m() const { return moved_m_; }

 private:
  enum class Stage : std::uint8_t { holding, turning, looking, advancing, stopping };
  StepOutcome turn(const hal::Pose& pose, hal::Instant now);
  StepOutcome look(const GuardVerdict& way, hal::Instant now);
  StepOutcome advance(const hal::Pose& pose, hal::Vec3 velocity, const GuardVerdict& way, hal::Instant now);
  StepOutcome stop(const hal::Pose& pose, hal::Vec3 velocity, hal::Instant now);
  StepOutcome finish(StepOutcome outcome);
  void hold_here(const hal::Pose& pose);
  [[nodiscard]] double along(hal::Vec3 v) const;
  void enter(Stage stage, hal::Instant now, hal::Duration allowed);

  StepFlightConfig config_;
  Stage stage_ = Stage::holding;
  hal::Vec3 start_world_;  // of the way
  hal::Vec3 began_world_;  // where the body was when the step began
  hal::Vec3 goal_world_;
  double yaw_rad_ = 0.0;
  double length_m_ = 0.0;
  double speed_m_s_ = 0.0;
  double run_m_ = 0.0;  // how far along its way the goal has run
  bool turned_ = false;
  double moved_m_ = 0.0;
  hal::Instant entered_;
  hal::Instant last_update_;
  hal::Deadline deadline_;
};

}  // namespace forager::flight
