#pragma once

#include "hal/error.hpp"

// UHAGV v5 (thesis sec. 6.10): a quadrotor docked on a platform with four omni wheels. The sum of the motors
// is a constant K_T; what moves the platform is how it is shared: rear motors faster than the front ones tilt
// the body by alpha about the docking axis and push it forward, front ones faster push it back, one diagonal
// pair faster turns it towards beta. Body frame, REP-103: pitch is positive nose down (forward), yaw positive
// to the left. (The thesis calls forward +Y.)
namespace forager::flight {

// Share of its full thrust for each motor, 0..1. X layout; front-left and rear-right turn clockwise seen from
// above, the other two counter-clockwise (ArduCopter's quad X).
struct OmniShares {
  double front_left = 0.0;
  double front_right = 0.0;
  double rear_left = 0.0;
  double rear_right = 0.0;
  [[nodiscard]] constexpr double total() const { return front_left + front_right + rear_left + rear_right; }
};

// Shares with a mean of exactly thrust (K_T / 4), whatever pitch and yaw ask for: each of them is half the
// difference between the pairs, positive for forward and left. Where a motor would leave 0..1 both are scaled
// down alike, so that the direction of the motion is kept and the platform is neither pressed down nor
// lifted. thrust is clamped to 0..1; values that are not finite give all motors 0.
[[nodiscard]] OmniShares omni_mix(double thrust, double pitch, double yaw);

struct OmniConfig {
  double thrust = 0.35;           // K_T as a share of the full thrust of all motors
  double max_alpha_rad = 0.35;    // 20 degrees
  double pitch_gain = 0.6;        // share per radian of what alpha lacks
  double pitch_damping_s = 0.15;  // share per rad/s
  double yaw_gain = 0.25;
  double yaw_damping_s = 0.12;
  double max_yaw = 0.15;  // share; a far heading is not turned to with all there is
};

// Errors: invalid_argument (a thrust not above 0 and below 1, a tilt not between 0 and 45 degrees, a gain
// that is negative, a yaw limit outside 0..1, or more thrust than `most_share`). most_share: of full thrust
// that carries the weight; below it the wheels keep their grip.
[[nodiscard]] hal::Result<> validate(const OmniConfig& config, double most_share);

struct OmniAttitude {
  double pitch_rad = 0.0;  // nose down positive
  double pitch_rate_rad_s = 0.0;
  double yaw_rad = 0.0;
  double yaw_rate_rad_s = 0.0;
};

// Shares that tilt the body to alpha and turn it to beta. alpha: positive forward, clamped to max_alpha_rad;
// beta: heading in the frame of attitude.yaw_rad, turned to by the short way. A demand or an attitude that is
// not finite gives all motors 0: nothing is pushed by what is not known.
[[nodiscard]] OmniShares omni_drive(double alpha_rad, double beta_rad, const OmniAttitude& attitude,
                                    const OmniConfig& config);

struct OmniForces {
  double forward_n = 0.0;  // K_T sin(alpha)
  double normal_n = 0.0;   // weight less K_T cos(alpha), on all wheels; not above 0: it lifts off
};
[[nodiscard]] OmniForces omni_forces(double thrust_n, double alpha_rad, double mass_kg);

}  // namespace forager::flight
