#pragma once

#include <cstdint>
#include <vector>

#include "hal/pose.hpp"
#include "mocks/gen2_beam_bound.hpp"
#include "mocks/gen2_field_fade.hpp"
#include "mocks/gen2_field_parameters.hpp"
#include "mocks/gen2_hazard_table.hpp"
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
  AirLink(const World& world, const std::vector<AntennaMounting>& antennas, const AirParameters& air,
          std::uint64_t seed);

  [[nodiscard]] AntennaView view(const hal::Pose& body, const RadioPort& port) const;
  [[nodiscard]] TagLink link(const AntennaView& antenna, std::uint32_t tag) const {
    return link_above(antenna, tag, 0.0);
  }
  // The same for a tag that only matters if its hazard rate is above `rate_per_s`; of one that certainly is
  // not, u is infinite, found out before its fade and obstacles are looked at.
  [[nodiscard]] TagLink link_above(const AntennaView& antenna, std::uint32_t tag, double rate_per_s) const;
  // Answers per second while the reader listens to this antenna and the tag's flag fits.
  [[nodiscard]] double hazard(const TagLink& link) const;
  // No antenna of a body within slack_m of body_position hears the tag at a higher rate; 0 if the tag is out
  // of reach or below the hazard cut.
  [[nodiscard]] double hazard_bound(hal::Vec3 body_position, double slack_m, double max_reach,
                                    std::uint32_t tag) const;
  // Range at 30 dBm without fade at which half of the tags like this one answer within T0.
  [[nodiscard]] double r0_m(std::uint32_t tag) const { return r0_m_[tag]; }
  [[nodiscard]] double spread_db(std::uint32_t tag) const { return spread_db_[tag]; }
  [[nodiscard]] double max_amplitude() const { return fade_.max_amplitude(); }
  // No antenna is farther from the body's centre.
  [[nodiscard]] double longest_arm_m() const { return longest_arm_m_; }
  [[nodiscard]] const HazardTable& hazard_table() const { return hazard_table_; }
  [[nodiscard]] double rssi_dbm(const AntennaView& antenna, const TagLink& link, std::uint32_t tag) const;
  // Two-way phase 4 pi R f/c, modulo 180 degrees.
  [[nodiscard]] static int phase_deg(double range_m, std::uint32_t frequency_khz);

 private:
  [[nodiscard]] int obstacles_between(hal::Vec3 antenna, hal::Vec3 tag) const;

  const World* world_;
  struct Mounted {
    AntennaMounting mounting;
    Axes axes_body;
  };
  std::vector<Mounted> antennas_;
  AirParameters air_;
  std::uint64_t seed_;  // of the axes of the tags
  FrozenFade fade_;
  HazardTable hazard_table_;
  BeamBound beam_bound_;
  double longest_arm_m_ = 0.0;
  std::vector<double> spread_db_;
  std::vector<double> r0_m_;  // of each tag at 30 dBm without fade
};

}  // namespace forager::mocks
