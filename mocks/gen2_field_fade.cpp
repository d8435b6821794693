#include "mocks/gen2_field_fade.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace forager::mocks {
namespace {

// The lattice of the value noise that has the wanted correlation length.
constexpr double kCellsPerLength = 1.3;
// Height folded into the plane; any pair of numbers that are no simple ratio.
constexpr double kSlantX = 0.7548776662466927;
constexpr double kSlantY = 0.5698402909980532;

std::uint64_t mix(std::uint64_t z) {  // finaliser of splitmix64
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

struct Scatter {
  double re;
  double im;
};

// Two independent numbers of variance 1, each the sum of two uniform ones.
Scatter node(std::uint64_t key, std::int64_t i, std::int64_t j) {
  const std::uint64_t bits = mix(key + static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15ULL +
                                 static_cast<std::uint64_t>(j) * 0xD1B54A32D192ED03ULL);
  constexpr double kScale = 2.449489742783178 / 65536.0;
  const auto part = [bits](int k) { return static_cast<double>((bits >> (16 * k)) & 0xFFFFU) - 32767.5; };
  return {(part(0) + part(1)) * kScale, (part(2) + part(3)) * kScale};
}

double smooth(double x) { return x * x * (3.0 - 2.0 * x); }

}  // namespace

FrozenFade::FrozenFade(double rician_k_db, double length_m, std::uint64_t seed)
    : off_(rician_k_db >= kNoFade_db), per_metre_(kCellsPerLength / length_m), seed_(mix(seed + 1)) {
  const double k = std::pow(10.0, 0.1 * rician_k_db);
  direct_ = off_ ? 1.0 : std::sqrt(k / (k + 1.0));
  scattered_ = off_ ? 0.0 : std::sqrt(1.0 / (k + 1.0));
}

double FrozenFade::amplitude(std::uint32_t tag, int port, hal::Vec3 antenna) const {
  if (off_) return 1.0;
  const double x = (antenna.x + kSlantX * antenna.z) * per_metre_;
  const double y = (antenna.y + kSlantY * antenna.z) * per_metre_;
  const double x0 = std::floor(x);
  const double y0 = std::floor(y);
  const double wx = smooth(x - x0);
  const double wy = smooth(y - y0);
  const auto i = static_cast<std::int64_t>(x0);
  const auto j = static_cast<std::int64_t>(y0);
  const std::uint64_t key =
      mix(seed_ ^ (std::uint64_t{tag} << 16) ^ static_cast<std::uint64_t>(static_cast<std::uint32_t>(port)));
  const Scatter a = node(key, i, j);
  const Scatter b = node(key, i + 1, j);
  const Scatter c = node(key, i, j + 1);
  const Scatter d = node(key, i + 1, j + 1);
  const auto blend = [&](double pa, double pb, double pc, double pd) {
    return (1.0 - wy) * ((1.0 - wx) * pa + wx * pb) + wy * ((1.0 - wx) * pc + wx * pd);
  };
  // Weights add in square: dividing by their norm keeps the variance at 1 between the nodes.
  const double norm = std::sqrt(((1.0 - wx) * (1.0 - wx) + wx * wx) * ((1.0 - wy) * (1.0 - wy) + wy * wy));
  const double part = scattered_ * std::numbers::sqrt2 * 0.5;
  const double re = part * std::clamp(blend(a.re, b.re, c.re, d.re) / norm, -kClip, kClip);
  const double im = part * std::clamp(blend(a.im, b.im, c.im, d.im) / norm, -kClip, kClip);
  return std::sqrt((direct_ + re) * (direct_ + re) + im * im);
}

}  // namespace forager::mocks
