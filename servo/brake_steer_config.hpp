#pragma once

#include <array>
#include <cstdint>

#include "hal/time.hpp"
#include "hal/units.hpp"
#include "servo/motion_estimate.hpp"

namespace forager::servo {

// What the loop believes of the vehicle before it has moved, and then learns.
struct SteerLearnt {
  double push_m_s2 = 0.7;         // acceleration under thrust, rolling straight
  double coast_m_s2 = 0.25;       // deceleration without
  double turn_push_rad_s2 = 0.9;  // the same about a locked wheel
  double turn_coast_rad_s2 = 0.35;
  double stop_lag_s = 0.13;  // from the command until the brakes grip, rolling straight
  std::array<double, 2> turn_stop_lag_s{0.13, 0.13};  // left and right turns
  double bend_rad_m = 0.0;                            // how its way bends by itself, left positive
  std::array<double, 2> dab_s{0.05, 0.05};            // left, right: a touch that turns it by dab_rad_s
};

struct BrakeSteerConfig {
  double half_track_m = 0.5;                 // sec. 6.6.2
  double thrust = 0.15;                      // constant, of full
  double pitch_rad = hal::deg_to_rad(22.0);  // fixed
  // Sets the speed by pitch at constant thrust (future work 1 of ch. 6) instead of by thrust at fixed pitch.
  bool speed_by_pitch = false;

  double max_speed_m_s = 0.55;
  double arrive_speed_m_s = 0.28;   // when the brakes take over
  double max_yaw_rate_rad_s = 0.8;  // tracking cameras lose confidence above 1.5
  double arrive_yaw_rate_rad_s = 0.40;
  double brake_m_s2 = 3.0;  // deceleration once the brakes grip
  double turn_brake_rad_s2 = 5.0;
  double thrust_lag_s = 0.12;  // pushes on for about so long after it was cut

  double goal_margin_m = 0.15;  // sec. 6.6.2
  double heading_margin_rad = hal::deg_to_rad(10.0);
  double accept_m = 0.06;  // nearer than this to the goal it is not worth moving
  double accept_heading_rad = hal::deg_to_rad(6.0);
  double step_accept_m = 0.12;            // of a step that is not the goal
  double step_miss_m = 0.07;              // passing a step at this distance is good enough
  double goal_miss_m = 0.035;             // the same at the goal
  double aim_rad = hal::deg_to_rad(2.5);  // heading error that is good enough to start rolling
  double dab_rad_s = 0.15;                // one touch of a brake while rolling; 0: never
  double heading_gain_1_s = 1.2;          // of bearing, while rolling
  int most_tries = 8;                     // plans for one step

  hal::Duration command_life = std::chrono::milliseconds(150);  // of what update() answers
  hal::Duration pose_hold = std::chrono::milliseconds(250);     // an older pose stops it
  hal::Duration pose_lost = std::chrono::seconds(3);            // and for so long is a fault
  hal::Duration settle = std::chrono::milliseconds(150);        // it stands when it stood for so long
  hal::Duration release = std::chrono::milliseconds(250);       // from opening the brakes to thrust
  hal::Duration no_motion = std::chrono::milliseconds(2500);
  hal::Duration runs_away = std::chrono::milliseconds(1500);  // both locked and moving for so long
  hal::Duration leg_time = std::chrono::seconds(40);

  MotionEstimateConfig estimate;
  SteerLearnt start;
};

struct SteerStats {
  std::uint32_t turns = 0;
  std::uint32_t drives = 0;
  std::uint32_t passed = 0;   // steps passed without stopping
  std::uint32_t replans = 0;  // stops for having left the line
  std::uint32_t dabs = 0;     // touches of one brake while rolling
  std::uint32_t holds = 0;    // stops for an expired command or an old pose
  std::uint32_t speed_checks = 0;
};

}  // namespace forager::servo
