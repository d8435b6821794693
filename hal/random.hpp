#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "hal/units.hpp"

namespace forager::hal {

// xoshiro256** (Blackman, Vigna 2018), seeded through splitmix64. The standard distributions are not
// specified to the bit and differ between libraries; these are. Copyable; one per component, forked by name
// so that adding a component does not shift the numbers of another.
class Random {
 public:
  explicit Random(std::uint64_t seed) {
    for (auto& word : state_) word = splitmix(seed);
  }

  [[nodiscard]] std::uint64_t next() {
    const std::uint64_t result = rotate(state_[1] * 5, 7) * 9;
    const std::uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = rotate(state_[3], 45);
    return result;
  }

  // Uniform in [0, 1), 53 bits.
  [[nodiscard]] double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * uniform(); }
  // Uniform in 0 .. bound-1 (bound > 0); bias below 2^-32 for bounds below 2^32.
  [[nodiscard]] std::uint64_t below(std::uint64_t bound) { return next() % bound; }
  [[nodiscard]] bool chance(double probability) { return uniform() < probability; }
  // Standard normal (Box-Muller, one of the pair).
  [[nodiscard]] double normal() {
    const double radius = std::sqrt(-2.0 * std::log1p(-uniform()));
    return radius * std::cos(2.0 * kPi * uniform());
  }
  // Exponential with mean 1.
  [[nodiscard]] double exponential() { return -std::log1p(-uniform()); }

  // An independent stream for a component; the same (seed, stream) gives the same numbers for ever.
  [[nodiscard]] static Random stream(std::uint64_t seed, std::uint64_t stream_id) {
    std::uint64_t mixed = seed;
    const std::uint64_t a = splitmix(mixed);
    mixed = stream_id ^ 0x9E3779B97F4A7C15ULL;
    return Random(a ^ rotate(splitmix(mixed), 32));
  }

 private:
  static std::uint64_t rotate(std::uint64_t x, int k) { return (x << k) | (x >> (64 - k)); }
  static std::uint64_t splitmix(std::uint64_t& x) {
    std::uint64_t z = (x += 0x9E3779B97F4A7C15ULL);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }
  std::array<std::uint64_t, 4> state_{};
};

}  // namespace forager::hal
