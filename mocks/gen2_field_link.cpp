#include "mocks/gen2_field_link.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hal/random.hpp"

namespace forager::mocks {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNominalPower_dbm = 30.0;
constexpr double kSpeedOfLight_m_s = 299792458.0;

double amplitude_of(double db) { return std::pow(10.0, db / 20.0); }
double db_of(double amplitude) { return 20.0 * std::log10(amplitude); }

bool inside(const Box& b, hal::Vec3 p) {
  return p.x >= b.min.x && p.x <= b.max.x && p.y >= b.min.y && p.y <= b.max.y && p.z >= b.min.z &&
         p.z <= b.max.z;
}

bool crosses(const Box& box, hal::Vec3 from, hal::Vec3 to) {
  double enter = 0.0;
  double leave = 1.0;
  const auto slab = [&](double a, double b, double low, double high) {
    if (a == b) {
      if (a <= low || a >= high) leave = -1.0;
      return;
    }
    const double s = (low - a) / (b - a);
    const double t = (high - a) / (b - a);
    enter = std::max(enter, std::min(s, t));
    leave = std::min(leave, std::max(s, t));
  };
  slab(from.x, to.x, box.min.x, box.max.x);
  slab(from.y, to.y, box.min.y, box.max.y);
  slab(from.z, to.z, box.min.z, box.max.z);
  return enter < leave;
}

}  // namespace

AirLink::AirLink(const World& world, const std::vector<AntennaMounting>& antennas, const AirParameters& air,
                 std::uint64_t seed)
    : world_(&world),
      air_(air),
      seed_(seed),
      fade_(air.rician_k_db, air.fade_length_m, seed),
      hazard_table_(air),
      beam_bound_(air.pattern) {
  hal::Random random = hal::Random::stream(seed, 1);
  spread_db_.reserve(world.tags.size());
  r0_m_.reserve(world.tags.size());
  for (std::size_t i = 0; i < world.tags.size(); ++i) {
    spread_db_.push_back(air.spread_db * std::clamp(random.normal(), -3.0, 3.0));
    r0_m_.push_back(air.r0_m * amplitude_of(spread_db_.back()));
  }
  for (const AntennaMounting& a : antennas) {
    longest_arm_m_ = std::max(longest_arm_m_, norm(a.position_body));
    antennas_.push_back({a, axes_of({{}, a.bearing_rad, -a.tilt_rad, 0.0})});
  }
}

AntennaView AirLink::view(const hal::Pose& body, const RadioPort& port) const {
  AntennaView view;
  view.port = port.port;
  view.power_db = port.power_dbm - kNominalPower_dbm;
  view.reach = amplitude_of(view.power_db);
  for (const Mounted& a : antennas_) {
    if (a.mounting.port != port.port) continue;
    const Axes body_axes = axes_of(body);
    view.fitted = true;
    view.position_world = body.position + body_axes.to_parent(a.mounting.position_body);
    view.axes_world = compose(body_axes, a.axes_body);
  }
  return view;
}

TagLink AirLink::link_above(const AntennaView& antenna, std::uint32_t tag, double rate_per_s) const {
  TagLink link;
  link.u = kInf;
  if (!antenna.fitted) return link;
  const hal::Vec3 offset = world_->tags.position(tag) - antenna.position_world;
  link.range_m = std::sqrt(Axes::dot(offset, offset));
  const double r0_m = r0_m_[tag] * antenna.reach;
  if (!(link.range_m <= air_.power_up_limit * r0_m * fade_.max_amplitude())) return link;
  const hal::Vec3 place = antenna.axes_world.from_parent(offset);
  const auto too_seldom = [&](double pattern_power) {
    const double r0_at_best_m = r0_m * fade_.max_amplitude();
    const double u = normalised_range(link.range_m, r0_at_best_m, pattern_power, air_.pattern_exponent);
    return hazard_table_.bound(u) <= rate_per_s;
  };
  if (rate_per_s > 0.0 && too_seldom(beam_bound_.bound(place, link.range_m))) return link;
  link.pattern_power = air_.pattern.power(place);
  if (link.pattern_power <= 0.0 || (rate_per_s > 0.0 && too_seldom(link.pattern_power))) return link;
  link.amplitude = fade_.amplitude(tag, antenna.port, antenna.position_world);
  if (air_.occlusion_db > 0.0)
    link.amplitude *= amplitude_of(-air_.occlusion_db *
                                   obstacles_between(antenna.position_world, world_->tags.position(tag)));
  if (air_.dipoles.axes != TagAxes::none)
    link.amplitude *= std::sqrt(orientation_power(air_.dipoles, tag, -1.0 * offset, seed_));
  link.u = std::max(
      normalised_range(link.range_m, r0_m * link.amplitude, link.pattern_power, air_.pattern_exponent),
      kNearestU);
  if (link.u > air_.power_up_limit) link.u = kInf;
  return link;
}

double AirLink::hazard(const TagLink& link) const { return expected_answers(link.u) / air_.t0_s; }

double AirLink::hazard_bound(hal::Vec3 body, double slack_m, double max_reach, std::uint32_t tag) const {
  const hal::Vec3 offset = world_->tags.position(tag) - body;
  const double nearest_m = std::max(std::sqrt(Axes::dot(offset, offset)) - longest_arm_m_ - slack_m, 0.0);
  return hazard_table_.bound(nearest_m / (r0_m_[tag] * max_reach * fade_.max_amplitude()));
}

double AirLink::rssi_dbm(const AntennaView& antenna, const TagLink& link, std::uint32_t tag) const {
  // What the reader hears went both ways through distance, pattern and fade, and once through the tag.
  return air_.rssi_at_1m_dbm + antenna.power_db + spread_db_[tag] +
         2.0 * (10.0 * std::log10(link.pattern_power) + db_of(link.amplitude) -
                db_of(std::max(link.range_m, 0.05)));
}

int AirLink::phase_deg(double range_m, std::uint32_t frequency_khz) {
  const double wavelengths = range_m * (1000.0 * frequency_khz) / kSpeedOfLight_m_s;
  const double phase = std::fmod(720.0 * wavelengths, 180.0);
  return static_cast<int>(std::lround(phase)) % 180;
}

// The shelf or box a tag lies in does not count: its own loss is part of the tag's sensitivity.
int AirLink::obstacles_between(hal::Vec3 antenna, hal::Vec3 tag) const {
  int count = 0;
  for (const Box& box : world_->obstacles)
    if (!inside(box, tag) && crosses(box, antenna, tag)) ++count;
  return count;
}

}  // namespace forager::mocks
