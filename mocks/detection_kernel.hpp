#pragma once

#include <span>
#include <string_view>

#include "hal/error.hpp"
#include "hal/pose.hpp"
#include "mocks/antenna_pattern.hpp"
#include "mocks/detection_lanes.hpp"

namespace forager::mocks {

// "paper", "plugin", "plugin as published". Errors: invalid_argument with the names there are.
[[nodiscard]] hal::Result<DetectionFormula> detection_formula(std::string_view name);
[[nodiscard]] std::string_view to_string(DetectionFormula formula);

struct DetectionSettings {
  AntennaPattern pattern;
  double r0_m = 1.0;  // of every tag, or what each tag's own R0 is a multiple of
  DetectionFormula formula = DetectionFormula::paper;
  // Probabilities below it are taken for 0: the error of a pair is below cut * (1 + 1e-12) (f32: 1e-5). 0:
  // none is.
  double cut = 0.0;
};

// Probability that one antenna hears one tag within T0, from the tag's place in the antenna frame (metres, x
// boresight, y left, z up) to PD = 2 / (1 + 3^u). Always within 0..1 and never NaN, whatever goes in: a point
// that is no number, behind, at the origin, at or beyond a null gives 0, overflow gives 0.
//
//   reference   libm arc tangents and cosines, compensated exponent (detection_probability_compensated)
//   probability the same without trigonometry (mocks/beam_series.hpp), a few roundings, one pair at a time
//   the spans   the same again over many tags, by vectors
// Antennas with a measured table have no series: there all of them look the table up, and only the curve goes
// by vectors.
class DetectionKernel {
 public:
  explicit DetectionKernel(const DetectionSettings& settings);
  DetectionKernel(const DetectionKernel& other);
  DetectionKernel& operator=(const DetectionKernel& other);
  ~DetectionKernel() = default;

  [[nodiscard]] double reference(hal::Vec3 point, double r0_factor = 1.0) const;
  [[nodiscard]] double probability(hal::Vec3 point, double r0_factor = 1.0) const;
  // |result - reference| <= 1e-15 for tags at 1 mm and farther whose pattern power is above 1e-6. All spans
  // of one length; r0_factor is empty or gives each tag's own R0 as a multiple of r0_m. Products and sums are
  // fused where the machine can: the results of two machines differ by 1e-15, and by nothing among those that
  // can.
  void probabilities(std::span<const double> x, std::span<const double> y, std::span<const double> z,
                     std::span<double> results, std::span<const double> r0_factor = {}) const;
  // |result - exact value for these floats| <= 2e-7 with the paper's formula, 3e-7 with the plugin's, for
  // tags at 10 cm and farther.
  void probabilities(std::span<const float> x, std::span<const float> y, std::span<const float> z,
                     std::span<float> results, std::span<const float> r0_factor = {}) const;

  // No tag farther than this many times its R0 has a PD above the cut, whatever the pattern. With a cut of 0,
  // the distance where the smallest double ends.
  [[nodiscard]] double farthest_r0() const { return farthest_r0_; }
  [[nodiscard]] const DetectionSettings& settings() const { return settings_; }

 private:
  template <class T>
  [[nodiscard]] LaneBeam<T> make_beam() const;
  template <class T>
  void run(const LaneBeam<T>& beam, std::span<const T> x, std::span<const T> y, std::span<const T> z,
           std::span<T> results, std::span<const T> r0_factor) const;
  void point_to_myself();

  DetectionSettings settings_;
  AntennaPattern exact_pattern_;
  double farthest_r0_ = 0.0;
  bool tabulated_ = false;
  LaneBeam<double> beam_;
  LaneBeam<float> beam_f32_;
};

}  // namespace forager::mocks
