#pragma once

#include <cstdint>

#include "hal/pose.hpp"

namespace forager::mocks {

// Multipath as a frozen landscape: for each (tag, port) an amplitude factor |h| over the place of the
// antenna, Rician with mean power 1. It is a hash of its arguments, holds no state, stays the same while the
// antenna stays, is continuous, and has forgotten itself after about one correlation length (test:
// correlation above 0.9 at a tenth of it, below 0.3 at one, 0 from two on). Height enters through a fixed
// slant: two places that differ by exactly that slant share their fade.
class FrozenFade {
 public:
  // From this K on there is no fade.
  static constexpr double kNoFade_db = 60.0;

  FrozenFade(double rician_k_db, double length_m, std::uint64_t seed);

  [[nodiscard]] double amplitude(std::uint32_t tag, int port, hal::Vec3 antenna_world) const;
  // No amplitude is above this.
  [[nodiscard]] double max_amplitude() const { return direct_ + kClip * scattered_; }

 private:
  // The scattered field's parts are cut here (0.3 % of a normal distribution), so that range has a limit.
  static constexpr double kClip = 3.0;

  bool off_;
  double direct_;     // amplitude of the direct path
  double scattered_;  // root mean square amplitude of the scattered ones
  double per_metre_;
  std::uint64_t seed_;
};

}  // namespace forager::mocks
