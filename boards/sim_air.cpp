#include "boards/sim_air.hpp"

namespace forager::boards {

mocks::AirParameters air_of(const Scene& scene) {
  const SceneRadio& radio = scene.world.radio;
  mocks::AirParameters air;
  air.r0_m = radio.r0_m;
  air.t0_s = radio.t0_s;
  air.pattern =
      radio.pattern == "gaussian"
          ? mocks::AntennaPattern::gaussian(radio.beam_horizontal_rad, radio.beam_vertical_rad)
          : mocks::AntennaPattern::cosine_squared(radio.beam_horizontal_rad, radio.beam_vertical_rad);
  air.pattern_exponent = radio.pattern_exponent;
  air.power_up_limit = radio.power_up_limit;
  air.spread_db = radio.spread_db;
  air.rician_k_db = radio.rician_k_db;
  air.occlusion_db = radio.occlusion_db;
  air.rssi_at_1m_dbm = radio.rssi_at_1m_dbm;
  air.patience_median_s = radio.patience_s;
  air.singulation_s = radio.singulation_s;
  return air;
}

std::vector<mocks::AntennaMounting> antennas_of(const Scene& scene) {
  std::vector<mocks::AntennaMounting> antennas;
  for (const reader::ReadPort& port : scene.read_plan.ports)
    antennas.push_back(
        {.port = port.port, .position_body = {}, .bearing_rad = port.bearing_rad, .tilt_rad = 0.0});
  return antennas;
}

}  // namespace forager::boards
