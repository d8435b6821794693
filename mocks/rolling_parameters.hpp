#pragma once

#include "hal/time.hpp"
#include "hal/units.hpp"

namespace forager::mocks {

// The laboratory's hybrid vehicle UHAGV v4 on its wheels (thesis ch. 6). What the thesis says is marked with
// its section; the rest is assumed from its list of parts (table 6.2) and marked so.
struct RollingParameters {
  double mass_kg = 3.5;             // assumption: 4S 6 Ah pack, four 900 kV motors, Pi, Pixhawk, two wheels
  double yaw_inertia_kg_m2 = 0.25;  // about the middle of the axle; assumption, most of it the wheels
  double half_track_m = 0.5;        // sec. 6.6.2: r = 0.5
  double gravity_m_s2 = 9.80665;

  double max_thrust_n = 50.0;        // all motors; assumption, 1.3 kgf each on 4S with 10 inch propellers
  double thrust_lag_s = 0.10;        // motor and propeller; assumption
  double pitch_lag_s = 0.20;         // body follows the demanded tilt; assumption
  double thrust_offset_m = 0.0;      // line of thrust left of the centre of mass: turns to the right
  double least_normal_share = 0.15;  // of the weight; below this it is about to lift (sec. 6.5: N > 0)

  double rolling_resistance = 0.025;  // c_rr, all wheels together; assumption, bicycle wheel to carpet
  double drag_asymmetry = 0.0;        // left wheel c_rr (1 + x), right wheel c_rr (1 - x)
  double surface_drag_n_s_m = 0.3;    // grows with speed; assumption
  double scrub_torque_n_m = 0.08;     // of the small front wheels and the turning contact patch; assumption
  double friction = 0.6;              // mu of wheel on floor; assumption, 0.3 polished to 0.8 rubber
  double front_load_share = 0.1;      // of the normal force on the small front wheels; assumption
  double grade_x = 0.0;               // rise of the floor per metre along world x and y
  double grade_y = 0.0;

  double brake_force_n = 9.0;   // at the rim of one wheel, fully pressed; assumption: 2.7 N m at 0.3 m
  double brake_contact = 0.25;  // share of the servo's travel before the pad touches; assumption
  double servo_lag_s = 0.06;    // first order; assumption, a digital servo of 0.1 s / 60 degrees
  double servo_dead_s = 0.02;   // one pulse period until it hears of a change (50 Hz)
  double servo_slew_1_s = 8.0;  // full travels a second at most; assumption

  // Fixed; the Coulomb contacts are solved implicitly, so it bounds accuracy, not stability.
  hal::Duration step = std::chrono::milliseconds(2);
};

// What is asked of the vehicle's actuators.
struct RollingCommand {
  double thrust = 0.0;      // 0..1 of max_thrust_n
  double pitch_rad = 0.0;   // nose down positive: F_x = F sin(pitch)
  double brake_left = 1.0;  // 0 open .. 1 fully pressed
  double brake_right = 1.0;
  bool operator==(const RollingCommand&) const = default;
};

}  // namespace forager::mocks
