#include "boards/sim_air.hpp"

#include <cmath>
#include <utility>

#include "mocks/gen2_field.hpp"
#include "mocks/gen2_slot_field.hpp"

namespace forager::boards {

hal::Result<mocks::AntennaPattern> pattern_of(const SceneRadio& radio) {
  using mocks::AntennaPattern;
  if (radio.pattern == "gaussian")
    return AntennaPattern::gaussian(radio.beam_horizontal_rad, radio.beam_vertical_rad);
  if (radio.pattern != "table")
    return AntennaPattern::cosine_squared(radio.beam_horizontal_rad, radio.beam_vertical_rad);
  const auto cut = [](const std::vector<ScenePatternSample>& samples) {
    std::vector<mocks::PatternSample> powers;
    powers.reserve(samples.size());
    for (const ScenePatternSample& sample : samples)
      powers.push_back({sample.angle_rad, std::pow(10.0, 0.1 * sample.gain_db)});
    return powers;
  };
  return AntennaPattern::table(cut(radio.pattern_azimuth), cut(radio.pattern_elevation));
}

mocks::AirParameters air_of(const Scene& scene) {
  const SceneRadio& radio = scene.world.radio;
  mocks::AirParameters air;
  air.r0_m = radio.r0_m;
  air.t0_s = radio.t0_s;
  if (auto pattern = pattern_of(radio)) air.pattern = std::move(*pattern);
  air.pattern_exponent = radio.pattern_exponent;
  air.power_up_limit = radio.power_up_limit;
  air.spread_db = radio.spread_db;
  air.rician_k_db = radio.rician_k_db;
  air.dipoles.axes = radio.tag_axes == "upright"     ? mocks::TagAxes::upright
                     : radio.tag_axes == "scattered" ? mocks::TagAxes::scattered
                                                     : mocks::TagAxes::none;
  air.dipoles.polarisation_loss_db = radio.polarisation_loss_db;
  air.occlusion_db = radio.occlusion_db;
  air.rssi_at_1m_dbm = radio.rssi_at_1m_dbm;
  const SceneSkip& skip = scene.world.skip;
  air.hazard_cut = skip.hazard_cut;
  air.skip_by_grid = skip.grid;
  air.skip_behind = skip.behind;
  air.skip_blind_antennas = skip.blind_antennas;
  air.skip_silent = skip.silent;
  air.unchanged_m = skip.unchanged_m;
  air.unchanged_rad = skip.unchanged_rad;
  air.patience_median_s = radio.patience_s;
  // What the round-level field leaves out it takes from the slots of the link.
  const mocks::RoundParameters round = mocks::round_parameters(slots_of(scene));
  air.round_s = round.round_s;
  air.singulation_s = radio.singulation_s.value_or(round.singulation_s);
  if (scene.world.air.dwell_s) {
    air.max_dwell_s = air.patience_median_s = *scene.world.air.dwell_s;
    air.patience_log_sigma = 0.0;
  }
  return air;
}

mocks::SlotParameters slots_of(const Scene& scene) {
  const SceneAir& air = scene.world.air;
  mocks::SlotParameters slots;
  slots.link = {
      .tari_us = air.tari_us, .pie = air.pie, .blf_khz = air.blf_khz, .m = air.m, .trext = air.pilot_tone};
  slots.first_q = air.first_q;
  slots.q_step = air.q_step;
  slots.round_overhead_s = air.round_overhead_s;
  slots.hop_interval_s = air.hop_interval_s;
  slots.capture_probability = air.capture_probability;
  return slots;
}

hal::Result<> check_air(const Scene& scene) {
  const auto named = [&scene](hal::Result<> result) {
    if (!result) result.error().device = scene.file;
    return result;
  };
  // Before the link's slots are counted, for they may be of any length.
  if (auto link = validate(slots_of(scene).link); !link) return named(std::move(link));
  if (auto pattern = pattern_of(scene.world.radio); !pattern)
    return named(hal::fail(std::move(pattern).error()));
  const mocks::AirParameters air = air_of(scene);
  if (auto valid = validate(air, antennas_of(scene)); !valid) return named(std::move(valid));
  return named(validate(slots_of(scene), air));
}

std::unique_ptr<mocks::TagField> make_field(const Scene& scene, const mocks::World& world,
                                            const mocks::TrueBody& body, std::uint64_t seed) {
  if (scene.world.air.model == AirModel::slot)
    return std::make_unique<mocks::SlotTagField>(world, body, antennas_of(scene), air_of(scene),
                                                 slots_of(scene), seed);
  return std::make_unique<mocks::SimTagField>(world, body, antennas_of(scene), air_of(scene), seed);
}

std::vector<mocks::AntennaMounting> antennas_of(const Scene& scene) {
  std::vector<mocks::AntennaMounting> antennas;
  for (const reader::ReadPort& port : scene.read_plan.ports)
    antennas.push_back(
        {.port = port.port, .position_body = {}, .bearing_rad = port.bearing_rad, .tilt_rad = 0.0});
  return antennas;
}

}  // namespace forager::boards
