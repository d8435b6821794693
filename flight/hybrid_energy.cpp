#include "flight/hybrid_energy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hal/units.hpp"

namespace forager::flight {
namespace {

hal::Failure wrong(std::string detail) {
  return hal::fail(hal::ErrorCode::invalid_argument, "energy estimate", "configure", std::move(detail));
}

bool positive(double value) { return value > 0.0 && std::isfinite(value); }
bool share(double value) { return value > 0.0 && value <= 1.0; }

}  // namespace

hal::Result<> validate(const EnergyAssumptions& a) {
  for (const double value : {a.mass_kg, a.gravity_m_s2, a.rotor_radius_m, a.air_density_kg_m3,
                             a.rolling_thrust_n, a.rolling_pitch_rad, a.rolling_speed_m_s, a.turn_rate_rad_s,
                             a.climb_m_s, a.descent_m_s, a.flight_m_s})
    if (!positive(value)) return wrong("a mass, size, thrust or speed is not positive");
  for (const double value : {a.electronics_w, a.rolling_resistance, a.stop_s, a.settle_s, a.arming_s})
    if (!(value >= 0.0 && std::isfinite(value))) return wrong("a power, resistance or time is negative");
  if (a.rotors < 1) return wrong("no rotors");
  if (!share(a.figure_of_merit) || !share(a.drive_efficiency) || !share(a.turn_share))
    return wrong("an efficiency or share is not above 0 and up to 1");
  const double normal = a.mass_kg * a.gravity_m_s2 - a.rolling_thrust_n * std::cos(a.rolling_pitch_rad);
  const double push = a.rolling_thrust_n * std::sin(a.rolling_pitch_rad);
  if (!(normal > 0.0)) return wrong("the rolling thrust lifts the vehicle");
  if (!(push > a.rolling_resistance * normal)) return wrong("the push does not overcome rolling resistance");
  return {};
}

double EnergyModel::thrust_power_w(double thrust_n) const {
  const double area = a_.rotors * hal::kPi * a_.rotor_radius_m * a_.rotor_radius_m;
  const double ideal = thrust_n * std::sqrt(thrust_n / (2.0 * a_.air_density_kg_m3 * area));
  return ideal / (a_.figure_of_merit * a_.drive_efficiency);
}

double EnergyModel::push_share() const {
  const double normal = a_.mass_kg * a_.gravity_m_s2 - a_.rolling_thrust_n * std::cos(a_.rolling_pitch_rad);
  const double push = a_.rolling_thrust_n * std::sin(a_.rolling_pitch_rad);
  return std::clamp(a_.rolling_resistance * normal / push, 0.0, 1.0);
}

EnergyEstimate EnergyModel::roll(double distance_m) const {
  const double rolling_s = distance_m / a_.rolling_speed_m_s;
  const double time_s = rolling_s + a_.stop_s;
  return {time_s, push_share() * thrust_power_w(a_.rolling_thrust_n) * rolling_s + a_.electronics_w * time_s};
}

EnergyEstimate EnergyModel::turn(double angle_rad) const {
  const double time_s = std::abs(angle_rad) / a_.turn_rate_rad_s;
  return {time_s, (a_.turn_share * thrust_power_w(a_.rolling_thrust_n) + a_.electronics_w) * time_s};
}

EnergyEstimate EnergyModel::roll_along(const std::vector<hal::Vec3>& way_world, double heading_rad) const {
  EnergyEstimate sum;
  for (std::size_t i = 1; i < way_world.size(); ++i) {
    const hal::Vec3 step = way_world[i] - way_world[i - 1];
    const double length = std::hypot(step.x, step.y);
    if (!(length > 0.0)) continue;
    const double heading = std::atan2(step.y, step.x);
    sum = sum + turn(hal::angle_difference(heading, heading_rad)) + roll(length);
    heading_rad = heading;
  }
  return sum;
}

EnergyEstimate EnergyModel::hop(const Hop& hop) const {
  const double weight = a_.mass_kg * a_.gravity_m_s2;
  const double hover_w = thrust_power_w(weight);
  const double up_s = hop.climb_m / a_.climb_m_s;
  const double airborne_s = up_s + hop.length_m / a_.flight_m_s + hop.climb_m / a_.descent_m_s + a_.settle_s;
  const double time_s = airborne_s + a_.arming_s;
  // Lifting comes on top of hovering; what sinking gives back is not counted.
  const double lift_j = weight * hop.climb_m / (a_.figure_of_merit * a_.drive_efficiency);
  return {time_s, hover_w * airborne_s + lift_j + a_.electronics_w * time_s};
}

double EnergyModel::rolled_instead_m(const Hop& hop) const {
  const double per_m = roll(1.0).energy_j - roll(0.0).energy_j;
  return this->hop(hop).energy_j / per_m;
}

std::vector<std::string> EnergyModel::assumptions() const {
  return {
      "estimate by momentum theory, static rotors; nothing of it was measured on the vehicle",
      fmt::format("mass {:.2f} kg, gravity {:.3f} m/s2", a_.mass_kg, a_.gravity_m_s2),
      fmt::format("{} rotors of {:.3f} m radius, air {:.2f} kg/m3", a_.rotors, a_.rotor_radius_m,
                  a_.air_density_kg_m3),
      fmt::format("figure of merit {:.2f}, motor and ESC {:.2f}, electronics {:.1f} W", a_.figure_of_merit,
                  a_.drive_efficiency, a_.electronics_w),
      fmt::format(
          "rolling: resistance {:.3f}, thrust {:.1f} N at {:.0f} degrees, {:.2f} m/s, {:.1f} s a stop",
          a_.rolling_resistance, a_.rolling_thrust_n, hal::rad_to_deg(a_.rolling_pitch_rad),
          a_.rolling_speed_m_s, a_.stop_s),
      fmt::format("turning: {:.2f} rad/s, pushed for {:.0f} % of the time", a_.turn_rate_rad_s,
                  100.0 * a_.turn_share),
      fmt::format(
          "flying: climb {:.2f}, forward {:.2f}, descent {:.2f} m/s, {:.1f} s hovering, {:.1f} s armed "
          "on the ground",
          a_.climb_m_s, a_.flight_m_s, a_.descent_m_s, a_.settle_s, a_.arming_s),
      fmt::format("follows: hovering {:.0f} W, rolling {:.1f} W on average",
                  thrust_power_w(a_.mass_kg * a_.gravity_m_s2),
                  push_share() * thrust_power_w(a_.rolling_thrust_n) + a_.electronics_w),
  };
}

}  // namespace forager::flight
