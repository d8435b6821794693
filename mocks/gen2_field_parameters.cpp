#include "mocks/gen2_field_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace forager::mocks {

hal::Result<> validate(const AirParameters& air, const std::vector<AntennaMounting>& antennas) {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  constexpr double kTiny = std::numeric_limits<double>::min();
  const struct {
    const char* name;
    double value;
    double low;
    double high;
  } fields[] = {
      {"r0_m", air.r0_m, 0.01, 1000.0},
      {"t0_s", air.t0_s, 1e-3, 1e6},
      {"pattern_exponent", air.pattern_exponent, 0.0, 10.0},
      {"power_up_limit", air.power_up_limit, kTiny, kAny},
      {"spread_db", air.spread_db, 0.0, 20.0},
      {"rician_k_db", air.rician_k_db, -40.0, kAny},
      {"fade_length_m", air.fade_length_m, 1e-3, 1e3},
      {"occlusion_db", air.occlusion_db, 0.0, 200.0},
      {"polarisation_loss_db", air.dipoles.polarisation_loss_db, 0.0, 60.0},
      {"rssi_at_1m_dbm", air.rssi_at_1m_dbm, -120.0, 0.0},
      {"rssi_noise_db", air.rssi_noise_db, 0.0, 20.0},
      {"patience_median_s", air.patience_median_s, 1e-3, 60.0},
      {"patience_log_sigma", air.patience_log_sigma, 0.0, 3.0},
      {"max_dwell_s", air.max_dwell_s, 1e-3, 60.0},
      {"settle_s", air.settle_s, 0.0, 1.0},
      {"singulation_s", air.singulation_s, 0.0, 1.0},
      {"round_s", air.round_s, 0.0, 10.0},
      {"s1_persistence_min_s", air.s1_persistence_min_s, 0.0, 1e6},
      {"s1_persistence_max_s", air.s1_persistence_max_s, air.s1_persistence_min_s, 1e6},
      {"s2_persistence_min_s", air.s2_persistence_min_s, 0.0, 1e6},
      {"s2_persistence_max_s", air.s2_persistence_max_s, air.s2_persistence_min_s, 1e6},
      {"hazard_cut", air.hazard_cut, 0.0, 1.0},
      {"unchanged_m", air.unchanged_m, 0.0, 0.1},
      {"unchanged_rad", air.unchanged_rad, 0.0, 0.1},
  };
  const auto refuse = [](std::string detail) {
    return hal::fail(hal::ErrorCode::invalid_argument, "simulated air", "check parameters",
                     std::move(detail));
  };
  for (const auto& field : fields)
    if (!(field.value >= field.low && field.value <= field.high))
      return refuse(
          fmt::format("{} = {} is not within {} to {}", field.name, field.value, field.low, field.high));
  for (std::size_t i = 0; i < antennas.size(); ++i) {
    const AntennaMounting& a = antennas[i];
    if (a.port < 1) return refuse(fmt::format("antenna {}: port {} is below 1", i, a.port));
    if (!is_finite(a.position_body) || !std::isfinite(a.bearing_rad) || !std::isfinite(a.tilt_rad))
      return refuse(fmt::format("antenna on port {}: mounting is not finite", a.port));
    const auto same = [&](const AntennaMounting& b) { return a.port == b.port; };
    if (std::count_if(antennas.begin(), antennas.end(), same) > 1)
      return refuse(fmt::format("two antennas on port {}", a.port));
  }
  return {};
}

}  // namespace forager::mocks
