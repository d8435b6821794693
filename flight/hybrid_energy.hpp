#pragma once

#include <string>
#include <vector>

#include "flight/hop_planner.hpp"
#include "hal/error.hpp"

// What rolling and hopping cost the battery, estimated. Nothing here was measured on the vehicle: the thesis
// publishes no figure of energy, and neither does this. Every assumption is a parameter and is printed beside
// the numbers that follow from it (assumptions()).
namespace forager::flight {

struct EnergyAssumptions {
  double mass_kg = 3.5;
  double gravity_m_s2 = 9.80665;
  int rotors = 4;
  double rotor_radius_m = 0.127;  // 10 inch propellers
  double air_density_kg_m3 = 1.2;
  double figure_of_merit = 0.6;    // ideal induced power to shaft power
  double drive_efficiency = 0.75;  // shaft power to battery power: motor and ESC
  double electronics_w = 12.0;     // computer, autopilot, camera; always on

  double rolling_resistance = 0.025;  // c_rr
  double rolling_thrust_n = 7.5;      // the constant thrust that pushes
  double rolling_pitch_rad = 0.384;   // 22 degrees
  double rolling_speed_m_s = 0.5;     // mean, between stops
  double turn_rate_rad_s = 0.5;       // mean, pivoting about a wheel
  double turn_share = 0.5;            // of a turn's time that it is pushed
  double stop_s = 2.0;                // braked, at each end of a straight way

  double climb_m_s = 0.5;
  double descent_m_s = 0.5;
  double flight_m_s = 0.5;
  double settle_s = 4.0;  // hovering: after the climb, before the descent, touching down
  double arming_s = 3.0;  // motors at idle on the ground, both ends
};

// Errors: invalid_argument (a parameter that is not finite or not positive, a share outside 0..1, a push that
// cannot overcome the rolling resistance).
[[nodiscard]] hal::Result<> validate(const EnergyAssumptions& assumptions);

struct EnergyEstimate {
  double time_s = 0.0;
  double energy_j = 0.0;
  friend EnergyEstimate operator+(EnergyEstimate a, EnergyEstimate b) {
    return {a.time_s + b.time_s, a.energy_j + b.energy_j};
  }
};

class EnergyModel {
 public:
  explicit EnergyModel(const EnergyAssumptions& assumptions) : a_(assumptions) {}

  // Battery power of all rotors together for a thrust: T^1.5 / sqrt(2 rho A) through both efficiencies
  // (momentum theory, static).
  [[nodiscard]] double thrust_power_w(double thrust_n) const;
  // Straight on, stops included. The push lasts as long as rolling resistance needs it: share c_rr N / F_x.
  [[nodiscard]] EnergyEstimate roll(double distance_m) const;
  [[nodiscard]] EnergyEstimate turn(double angle_rad) const;
  // Along a line of points, turning at each corner; heading: the one it starts with.
  [[nodiscard]] EnergyEstimate roll_along(const std::vector<hal::Vec3>& way_world, double heading_rad) const;
  // From standing on the ground to standing on the ground.
  [[nodiscard]] EnergyEstimate hop(const Hop& hop) const;
  // Metres that could be rolled for the energy of this hop.
  [[nodiscard]] double rolled_instead_m(const Hop& hop) const;

  // One line each, "mass 3.50 kg", for whoever reads the numbers.
  [[nodiscard]] std::vector<std::string> assumptions() const;

 private:
  [[nodiscard]] double push_share() const;

  EnergyAssumptions a_;
};

}  // namespace forager::flight
