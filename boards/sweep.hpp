#pragma once

#include <cstdint>
#include <vector>

#include "mocks/detection_kernel.hpp"
#include "mocks/gen2_field_parameters.hpp"
#include "mocks/tag_grid.hpp"
#include "mocks/world.hpp"

namespace forager::boards {

// An inventory sweep whose outcome can be told exactly: an antenna that looks to the left is carried evenly
// along the middle of a hall full of tags in plain view; no fade, no spread, no power-up limit, one port,
// tags that stay silent once counted. Then tag i is found with probability 1 - exp(-L integral lambda_i dt /
// T), where lambda is the hazard rate of equation 4.3 and L of the T seconds were listened.
struct Sweep {
  static constexpr double kDuration_s = 60.0;
  static constexpr double kSpeed_m_s = 0.25;
  static constexpr double kHeight_m = 1.1;
  static constexpr double kR0_m = 2.0;
  static constexpr double kT0_s = 5.0;
  static constexpr std::size_t kPlaces = 151;  // at which hazards are taken: every 10 cm

  mocks::World world;
  mocks::AirParameters air;
  mocks::AntennaMounting antenna;
  std::vector<double> exact_exposure;  // by tag: the integral, to 1e-13 of it with these places (trapezoids)

  Sweep(std::uint64_t seed, std::size_t tags);
  [[nodiscard]] hal::Vec3 place(double t_s) const;
  // Tags found in expectation when this share of the time was listened.
  [[nodiscard]] double expected_tags(const std::vector<double>& exposure, double listened_share = 1.0) const;
};

// The same by a DetectionKernel; tags out of its reach are left out by a grid, or not.
class SweepByKernel {
 public:
  enum class Way : std::uint8_t { f32, f64, compensated };
  SweepByKernel(const Sweep& sweep, Way way, double cut, bool grid);
  // Integral of the hazard of each tag.
  [[nodiscard]] const std::vector<double>& exposure();

 private:
  void visit(hal::Vec3 place, double weight_s);

  const Sweep* sweep_;
  Way way_;
  mocks::DetectionKernel kernel_;
  mocks::TagGrid grid_;
  double radius_m_;
  bool by_grid_;
  std::vector<std::uint32_t> near_;
  std::vector<double> x_, y_, z_, p_;
  std::vector<float> x_f32_, y_f32_, z_f32_, p_f32_;
  std::vector<double> exposure_;
};

}  // namespace forager::boards
