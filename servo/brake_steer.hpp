#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "hal/error.hpp"
#include "hal/pose.hpp"
#include "hal/pose_source.hpp"
#include "hal/time.hpp"
#include "hal/units.hpp"
#include "servo/brake_command.hpp"
#include "servo/brake_steer_config.hpp"
#include "servo/motion_estimate.hpp"
#include "servo/turn_then_drive.hpp"

namespace forager::servo {

// What came in since the last update.
struct SteerInput {
  std::optional<hal::PoseSample> pose;   // body in the world frame
  std::optional<double> yaw_rate_rad_s;  // a gyro's, positive left; optional
};

// What to do until `brakes.valid_until`; nobody may follow it from then on.
struct SteerOutput {
  BrakeCommand brakes;
  double thrust = 0.0;     // 0..1
  double pitch_rad = 0.0;  // nose down positive
};

enum class SteerPhase : std::uint8_t {
  idle,       // nothing to do
  holding,    // stopped: the command ran out or the pose is gone; geometry kept
  settling,   // stopped: waits until it stands, then plans
  turning,    // one wheel locked, thrust
  turn_ends,  // one wheel locked, no thrust
  releasing,  // both brakes open, no thrust yet
  driving,    // both open, thrust
  coasting,   // both open, no thrust
  arrived,    // stopped within both margins of the goal
  failed,     // stopped, see fault()
};
[[nodiscard]] std::string_view to_string(SteerPhase phase);

enum class SteerFault : std::uint8_t {
  none,
  no_motion,    // thrust, an open wheel, and it does not move: motors dead or a brake stuck
  spins,        // both brakes open, and it turns again and again: one of them drags
  runs_away,    // both locked, and it moves: brakes gone, or no grip
  pose_lost,    // no pose for too long
  unreachable,  // no turn leads to the step
  late,         // a leg took too long
  missed,       // the goal was not met in all tries
};
[[nodiscard]] std::string_view to_string(SteerFault fault);

// A place to pass through. World frame.
struct SteerStep {
  double x_m = 0.0;
  double y_m = 0.0;
};

// Turn-then-drive in closed loop (thesis sec. 6.6.2, with the geometry of turn_then_drive.hpp).
//
//   settling -> turning -> turn_ends -> settling -> releasing -> driving -> coasting -> settling ... arrived
//
// Per step: lock the inner wheel, push until what is left is the angle it will coast and brake, release; then
// open both, push until the coasting distance, coast, lock both. A step straight ahead of the next is passed
// without stopping. Every leg is planned anew from where the vehicle really stands, so slip, one-sided drag
// and a servo's lag cost an extra turn, never an error that grows. How far it coasts, how long the brakes
// take and how its way bends are learnt on the way (SteerLearnt).
//
// Stops with both brakes locked and no thrust when the mission's own command expires (renew), when the pose
// is older than pose_hold, on a fault and at the end. After an expiry or a gap it plans again from where it
// stands, once it is told to go on.
//
// update() costs well below 2 us and allocates nothing.
class BrakeSteer {
 public:
  explicit BrakeSteer(const BrakeSteerConfig& config);

  // Whether begin() would take them; the same errors.
  [[nodiscard]] static hal::Result<> usable(std::span<const SteerStep> steps,
                                            std::optional<double> goal_heading_rad);
  // Starts towards the last of these steps. goal_heading_rad: the heading to have there, if any.
  // Errors: invalid_argument (no step, a step or heading that is not finite).
  [[nodiscard]] hal::Result<> begin(std::span<const SteerStep> steps, std::optional<double> goal_heading_rad,
                                    hal::Instant now);
  // Whoever wants it to move says so again before this runs out.
  void renew(hal::Instant valid_until) { valid_until_ = valid_until; }
  // Ends the mission where it is.
  void stop() { phase_ = SteerPhase::idle; }

  [[nodiscard]] SteerOutput update(const SteerInput& input, hal::Instant now);

  [[nodiscard]] SteerPhase phase() const { return phase_; }
  [[nodiscard]] SteerFault fault() const { return fault_; }
  [[nodiscard]] bool done() const { return phase_ == SteerPhase::arrived || phase_ == SteerPhase::failed; }
  [[nodiscard]] std::size_t step() const { return step_; }
  [[nodiscard]] std::size_t steps() const { return steps_.size(); }
  [[nodiscard]] const SteerStats& stats() const { return stats_; }
  [[nodiscard]] const SteerLearnt& learnt() const { return learnt_; }
  [[nodiscard]] const MotionEstimate& estimate() const { return estimate_; }
  // Set by the watchdogs; a safety core may ask for the end as well.
  void fail(SteerFault fault);

 private:
  struct Aim {  // a step seen from the vehicle
    double ahead_m = 0.0;
    double left_m = 0.0;
    double distance_m = 0.0;
    double bearing_rad = 0.0;
  };
  [[nodiscard]] Aim aim_at(const SteerStep& step) const;
  [[nodiscard]] bool last_step() const { return step_ + 1 >= steps_.size(); }
  void enter(SteerPhase phase, hal::Instant now);
  void expect(hal::Instant now);
  [[nodiscard]] bool may_move(hal::Instant now);
  void run(hal::Instant now);
  [[nodiscard]] SteerOutput output(hal::Instant now) const;
  [[nodiscard]] double pitch_for_speed(double wanted, double speed, double push, double coast,
                                       hal::Instant now) const;

  // brake_steer_plan.cpp
  void settle(hal::Instant now);
  void plan(hal::Instant now);
  void finish(hal::Instant now);
  void start_turn(Brake side, double angle_rad, hal::Instant now);
  void next_step(hal::Instant now);
  void start_drive(const SteerStep& to, double miss_m, hal::Instant now);
  void count_try();

  // brake_steer_motion.cpp
  void turn(hal::Instant now);
  void drive(hal::Instant now);
  void watch(hal::Instant now);
  [[nodiscard]] double angle_left() const;
  void keep_line(const Aim& here, hal::Instant now);
  [[nodiscard]] double miss_of(const Aim& aim) const;
  [[nodiscard]] bool pass_on(const Aim& here);
  void learn_stop();
  void learn_rates(hal::Instant now);

  struct Mark {  // for learning from what follows
    hal::Instant at;
    double speed = 0.0;
    double yaw_rate = 0.0;
    hal::Pose pose;
    bool set = false;
  };

  BrakeSteerConfig config_;
  MotionEstimate estimate_;
  SteerLearnt learnt_;
  SteerStats stats_;
  std::vector<SteerStep> steps_;
  std::size_t step_ = 0;
  std::optional<double> goal_heading_rad_;
  hal::Instant since_;      // of the phase
  hal::Instant leg_since_;  // of the present step
  hal::Instant valid_until_{hal::Duration::min()};
  std::optional<hal::Instant> still_since_;
  std::optional<hal::Instant> stuck_since_;  // pushed, and still about where it was then
  std::optional<hal::Instant> runaway_since_;
  hal::Pose stuck_at_;
  Mark stop_mark_;  // when the brakes were told to lock
  Mark rate_mark_;  // when thrust went on or off

  double turn_left_ = 0.0;   // towards side_, at the last update
  SteerStep drive_to_;       // the step, or a point on the way to being able to turn
  double leg_miss_m_ = 0.0;  // what this drive may pass its target at
  double pitch_command_ = 0.0;
  hal::Instant dab_until_;
  hal::Instant dab_judged_;  // when its effect shows
  double dab_from_ = 0.0;    // yaw rate before it

  std::uint32_t resets_ = 0;  // of the estimate, as of the last update
  int spins_ = 0;             // in a row
  int tries_ = 0;             // at the present step
  SteerPhase phase_ = SteerPhase::idle;
  SteerFault fault_ = SteerFault::none;
  Brake side_ = Brake::none;  // of the present turn
  Brake dab_ = Brake::none;   // touched now, until dab_until_
  bool to_heading_ = false;   // the turn is for the goal's heading, not for a step
  bool roll_first_ = false;
  bool checking_speed_ = false;  // brakes against running too fast
  bool dab_open_ = false;        // not judged yet
};

}  // namespace forager::servo
