#pragma once

#include <cstdint>

#include "hal/pose.hpp"

namespace forager::mocks {

// Which way the dipoles of the tags lie.
enum class TagAxes : std::uint8_t {
  none,  // every tag hears equally well in all directions; what its orientation costs is in its sensitivity
  upright,    // along the vertical
  scattered,  // evenly over all directions, fixed for each tag
};

// A label is a half-wave dipole: deaf along its axis, best across it. And it hears one linear polarisation
// only, of the circular one of the reader's antenna half the power.
struct TagDipoles {
  TagAxes axes = TagAxes::none;
  double polarisation_loss_db = 3.0103;  // linear tag before a circular antenna; 0 if R0 was measured with it
  bool operator==(const TagDipoles&) const = default;
};

// Power a half-wave dipole takes up from a direction, over that from broadside: (cos(pi/2 c) / sin)^2 for c
// the cosine of the angle between them. 1 for c = 0, exactly 0 along the axis; never NaN, and 0 for c that is
// none.
[[nodiscard]] double dipole_power(double cos_to_axis);

// Unit vector along the dipole of a tag.
[[nodiscard]] hal::Vec3 dipole_axis(TagAxes axes, std::uint32_t tag, std::uint64_t seed);

// Power of both effects for a tag whose antenna lies in this direction (any length), 0..1. 1 for
// TagAxes::none.
[[nodiscard]] double orientation_power(const TagDipoles& dipoles, std::uint32_t tag, hal::Vec3 to_antenna,
                                       std::uint64_t seed);

}  // namespace forager::mocks
