#include "flight/omni_mixing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hal/units.hpp"

namespace forager::flight {
namespace {

constexpr double kGravity = 9.80665;

hal::Failure wrong(std::string detail, std::string mend = {}) {
  return hal::fail(hal::ErrorCode::invalid_argument, "omni platform", "configure", std::move(detail),
                   std::move(mend));
}

bool all_finite(const OmniAttitude& a) {
  return std::isfinite(a.pitch_rad) && std::isfinite(a.pitch_rate_rad_s) && std::isfinite(a.yaw_rad) &&
         std::isfinite(a.yaw_rate_rad_s);
}

}  // namespace

OmniShares omni_mix(double thrust, double pitch, double yaw) {
  if (!std::isfinite(thrust) || !std::isfinite(pitch) || !std::isfinite(yaw)) return {};
  const double mean = std::clamp(thrust, 0.0, 1.0);
  // The largest difference any motor sees is |pitch| + |yaw|, once up and once down.
  const double most = std::abs(pitch) + std::abs(yaw);
  const double room = std::min(mean, 1.0 - mean);
  const double scale = most > room ? room / most : 1.0;
  const double p = scale * pitch;
  const double y = scale * yaw;
  // Clockwise rotors turn the body to the left. Clamped against the last rounding only.
  const auto share = [mean](double difference) { return std::clamp(mean + difference, 0.0, 1.0); };
  return {share(-p + y), share(-p - y), share(p - y), share(p + y)};
}

hal::Result<> validate(const OmniConfig& config, double most_share) {
  if (!(config.thrust > 0.0 && config.thrust < 1.0))
    return wrong(fmt::format("a thrust of {} is not between 0 and 1", config.thrust));
  if (config.thrust > most_share)
    return wrong(fmt::format("a thrust of {} is above {}: too little weight is left on the wheels",
                             config.thrust, most_share));
  if (!(config.max_alpha_rad > 0.0 && config.max_alpha_rad <= hal::kPi / 4.0))
    return wrong(
        fmt::format("a tilt of {} degrees is not between 0 and 45", hal::rad_to_deg(config.max_alpha_rad)));
  for (const double gain : {config.pitch_gain, config.pitch_damping_s, config.yaw_gain, config.yaw_damping_s})
    if (!(gain >= 0.0 && std::isfinite(gain))) return wrong("a gain is negative or no number");
  if (!(config.max_yaw >= 0.0 && config.max_yaw <= 1.0))
    return wrong(fmt::format("a yaw limit of {} is not in 0..1", config.max_yaw));
  return {};
}

OmniShares omni_drive(double alpha_rad, double beta_rad, const OmniAttitude& attitude,
                      const OmniConfig& config) {
  if (!std::isfinite(alpha_rad) || !std::isfinite(beta_rad) || !all_finite(attitude)) return {};
  const double alpha = std::clamp(alpha_rad, -config.max_alpha_rad, config.max_alpha_rad);
  const double pitch =
      config.pitch_gain * (alpha - attitude.pitch_rad) - config.pitch_damping_s * attitude.pitch_rate_rad_s;
  const double lacking = hal::angle_difference(beta_rad, attitude.yaw_rad);
  const double yaw = config.yaw_gain * lacking - config.yaw_damping_s * attitude.yaw_rate_rad_s;
  return omni_mix(config.thrust, pitch, std::clamp(yaw, -config.max_yaw, config.max_yaw));
}

OmniForces omni_forces(double thrust_n, double alpha_rad, double mass_kg) {
  return {thrust_n * std::sin(alpha_rad), mass_kg * kGravity - thrust_n * std::cos(alpha_rad)};
}

}  // namespace forager::flight
