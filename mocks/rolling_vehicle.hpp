#pragma once

#include <cstdint>

#include "hal/time.hpp"
#include "mocks/body.hpp"
#include "mocks/rolling_brake.hpp"
#include "mocks/rolling_parameters.hpp"

namespace forager::mocks {

enum class WheelState : std::uint8_t {
  rolling,
  held,     // stands still on the floor
  sliding,  // locked, and the floor does not hold it
};

// Where the energy went since the start, joules. put_in = kinetic + climbed + everything taken.
struct RollingEnergy {
  double put_in = 0.0;   // by thrust
  double climbed = 0.0;  // against the slope
  double brakes = 0.0;   // pads, and wheels dragged over the floor
  double rolling = 0.0;  // rolling resistance
  double surface = 0.0;  // drag that grows with speed
  double scrub = 0.0;    // turning and slipping sideways
  [[nodiscard]] double taken() const { return brakes + rolling + surface + scrub; }
};

// UHAGV v4 on the ground: thrust along the pitched body, two free wheels with a brake each.
//   F_x = F sin(pitch), N = m g - F cos(pitch), m v' = F_x - c_rr N - ..., and about a locked wheel
//   (I_zz + m r^2) w' = F_x r - friction (thesis ch. 6 with the forces of Fig. 6.2).
// Every wheel is a dry contact: brake and rolling resistance hold it up to their sum, and the floor holds a
// locked wheel up to mu N, so more thrust means less grip. Both contacts of a step are solved together and
// exactly, hence nothing creeps at rest. Centre of mass over the axle; wheels without inertia; no load moves
// from side to side (the track is five times the height). Thrust that takes the weight off lifts(), here it
// only loses all grip. The body pose is the middle of the axle, REP-103.
//
// Deterministic: equal commands at equal times give equal states, whatever the spacing of update().
class RollingVehicle final : public TrueBody {
 public:
  explicit RollingVehicle(const RollingParameters& parameters, hal::Pose start = {});

  void command(const RollingCommand& command) { command_ = command; }
  // The same in two halves: what the autopilot does, and what the brakes' outputs do.
  void push(double thrust, double pitch_rad) {
    command_.thrust = thrust;
    command_.pitch_rad = pitch_rad;
  }
  void press(double left, double right) {
    command_.brake_left = left;
    command_.brake_right = right;
  }
  // Runs whole steps up to `now`. The first call only sets the clock.
  void update(hal::Instant now);
  // One step of parameters().step.
  void step();

  [[nodiscard]] const BodyState& state() const override { return state_; }
  void set_armed(bool armed) { state_.armed = armed; }
  [[nodiscard]] const RollingParameters& parameters() const { return parameters_; }
  [[nodiscard]] const RollingCommand& command() const { return command_; }
  [[nodiscard]] RollingBrake& left_brake() { return left_; }
  [[nodiscard]] RollingBrake& right_brake() { return right_; }
  // Motors that died: what is left of the thrust, and how far left of the middle it pulls.
  void set_thrust_fault(double share, double offset_m) {
    thrust_share_ = share;
    fault_offset_m_ = offset_m;
  }
  // The floor changes under way (a wet patch).
  void set_friction(double mu) { parameters_.friction = mu; }
  // Stands there, still and without thrust; for a vehicle that landed on its wheels.
  void stand_at(hal::Pose pose);
  // Sets it rolling; for tests.
  void set_motion(double speed_m_s, double yaw_rate_rad_s);

  [[nodiscard]] double speed_m_s() const { return speed_; }  // forward, middle of the axle
  [[nodiscard]] double side_slip_m_s() const { return side_; }
  [[nodiscard]] WheelState left_wheel() const { return left_wheel_; }
  [[nodiscard]] WheelState right_wheel() const { return right_wheel_; }
  [[nodiscard]] double thrust_n() const { return thrust_n_; }
  [[nodiscard]] double drive_force_n() const { return drive_n_; }  // F_x
  [[nodiscard]] double normal_n() const { return normal_n_; }
  [[nodiscard]] double left_brake_n() const { return left_.force_n(); }
  [[nodiscard]] double right_brake_n() const { return right_.force_n(); }
  [[nodiscard]] bool lifts() const { return lifts_; }  // the normal force has no margin left
  [[nodiscard]] double kinetic_j() const;
  [[nodiscard]] const RollingEnergy& energy() const { return energy_; }

 private:
  struct Contact {
    double limit_n = 0.0;    // the most it can pull against its motion
    double rolling_n = 0.0;  // of it, rolling resistance
    bool floor = false;      // the floor gives way first
  };
  struct Push {
    double slope_n = 0.0;
    double surface_n = 0.0;
    double torque_n_m = 0.0;
    double scrub_n_m = 0.0;
  };
  [[nodiscard]] Contact contact(double brake_n, double resistance, double wheel_normal_n) const;
  void drive(double dt);
  void settle(const Push& push, double dt);
  void book_wheel(const Contact& wheel, double impulse, double mean_speed);
  void slide_sideways(double yaw_rate, double used_n, double dt);
  void move(double speed, double yaw_rate, double dt);

  RollingParameters parameters_;
  RollingCommand command_;
  RollingBrake left_;
  RollingBrake right_;
  BodyState state_;
  RollingEnergy energy_;
  double thrust_blend_;
  double pitch_blend_;
  double thrust_n_ = 0.0;
  double pitch_rad_ = 0.0;
  double drive_n_ = 0.0;
  double normal_n_ = 0.0;
  double speed_ = 0.0;
  double side_ = 0.0;  // to the left; not zero only while it slips
  double thrust_share_ = 1.0;
  double fault_offset_m_ = 0.0;
  WheelState left_wheel_ = WheelState::held;
  WheelState right_wheel_ = WheelState::held;
  bool lifts_ = false;
  bool started_ = false;
  hal::Instant clock_;
};

}  // namespace forager::mocks
