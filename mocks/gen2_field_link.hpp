#pragma once

#include <cstdint>
#include <vector>

#include "hal/pose.hpp"
#include "mocks/gen2_field_fade.hpp"
#include "mocks/gen2_field_parameters.hpp"
#include "mocks/rotation.hpp"
#include "mocks/tag_field.hpp"
#include "mocks/world.hpp"

namespace forager::mocks {

// An antenna in the world while it radiates.
struct AntennaView {
  int port = 0;
  bool fitted = false;  // an antenna hangs on this port
  hal::Vec3 position_world;
  Axes axes_world;
  double power_db = 0.0;  // above 30 dBm
  double reach = 1.0;     // 10^(power_db/20): the forward link limits a passive tag, and power falls with R^2
};

// One antenna, one tag, one moment.
struct TagLink {
  double range_m = 0.0;
  double pattern_power = 0.0;
  double amplitude = 0.0;  // fade and occlusion
  double u = 0.0;          // normalised range; infinite if the tag gets no power
};

// The link budget: u_i = R / (R0 10^((spread_i + fade + occlusion + power)/20) D0^e), no power beyond the
// power-up limit.
class AirLink {
 public:
  AirLink(const World& world, std::vector<AntennaMounting> antennas, const AirParameters& air,
          std::uint64_t seed);

  [[nodiscard]] AntennaView view(const hal::Pose& body, const RadioPort& port) const;
  [[nodiscard]] TagLink link(const AntennaView& antenna, std::uint32_t tag) const;
  // Answers per second while the reader listens to this antenna and the tag's flag fits.
  [[nodiscard]] double hazard(const TagLink& link) const;
  // No antenna of a body within slack_m of body_position hears the tag at a higher rate; 0 if the tag is out
  // of reach or below the hazard cut.
  [[nodiscard]] double hazard_bound(hal::Vec3 body_position, double slack_m, double max_reach,
                                    std::uint32_t tag) const;
  [[nodiscard]] double rssi_dbm(const AntennaView& antenna, const TagLink& link, std::uint32_t tag) const;
  // Two-way phase 4 pi R f/c, modulo 180 degrees.
  [[nodiscard]] static int phase_deg(double range_m, std::uint32_t frequency_khz);

 private:
  [[nodiscard]] int obstacles_between(hal::Vec3 antenna, hal::Vec3 tag) const;

  const World* world_;
  std::vector<AntennaMounting> antennas_;
  AirParameters air_;
  FrozenFade fade_;
  double longest_arm_m_ = 0.0;
  std::vector<double> spread_db_;
  std::vector<double> r0_m_;  // of each tag at 30 dBm without fade
};

}  // namespace forager::mocks
