#include "mocks/tag_dipole.hpp"

#include <cmath>

#include "hal/random.hpp"
#include "hal/units.hpp"

namespace forager::mocks {

double dipole_power(double cos_to_axis) {
  const double c = std::abs(cos_to_axis);
  if (!(c < 1.0)) return 0.0;
  // Near the axis both cosine and sine vanish; as functions of 1 - c neither loses a digit.
  const double rest = 1.0 - c;
  const double numerator = std::sin(hal::kPi / 2.0 * rest);
  return std::fmin(numerator * numerator / (rest * (1.0 + c)), 1.0);
}

hal::Vec3 dipole_axis(TagAxes axes, std::uint32_t tag, std::uint64_t seed) {
  if (axes != TagAxes::scattered) return {0.0, 0.0, 1.0};
  // Archimedes: the height of an even point on a sphere is even.
  hal::Random random = hal::Random::stream(seed, 0xD1901E00000000ULL + tag);
  const double z = random.uniform(-1.0, 1.0);
  const double turn = random.uniform(0.0, 2.0 * hal::kPi);
  const double across = std::sqrt((1.0 - z) * (1.0 + z));
  return {across * std::cos(turn), across * std::sin(turn), z};
}

double orientation_power(const TagDipoles& dipoles, std::uint32_t tag, hal::Vec3 to_antenna,
                         std::uint64_t seed) {
  if (dipoles.axes == TagAxes::none) return 1.0;
  const hal::Vec3 axis = dipole_axis(dipoles.axes, tag, seed);
  const double along = axis.x * to_antenna.x + axis.y * to_antenna.y + axis.z * to_antenna.z;
  const double cos_to_axis = along / hal::norm(to_antenna);
  const double heard = dipole_power(cos_to_axis);
  return heard * std::pow(10.0, -dipoles.polarisation_loss_db / 10.0);
}

}  // namespace forager::mocks
