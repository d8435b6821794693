#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "mocks/beam_series.hpp"

namespace forager::mocks {

// What the inner loops of DetectionKernel share. Everybody else uses mocks/detection_kernel.hpp.

// How the pattern's amplitude, the square root of its power, comes about.
enum class BeamForm : unsigned char {
  cosine,    // product of two cosine series
  gaussian,  // 2 to minus the sum of two series
  algebraic  // both widths 90 degrees: x/R, no series at all
};

// How range and pattern make the normalised range u.
enum class DetectionFormula : unsigned char {
  paper,                // R / (R0 sqrt(D0))
  plugin,               // R / (R0 D0): the exponent of the laboratory's published plugin
  plugin_as_published,  // hypot(x, y) / (R0 D0), elevation acos(x / hypot(x, z)): its geometry, too
};

// 2^r for |r| <= 1/2 in powers of r, through the Chebyshev points: relative error below 4.3e-18 and 2.6e-9.
template <class T>
inline constexpr std::array<T, 12> kExp2Series{};
template <>
inline constexpr std::array<double, 12> kExp2Series<double>{1.0,
                                                            0.6931471805599453,
                                                            0.24022650695910158,
                                                            0.055504108664821625,
                                                            0.009618129107587256,
                                                            0.001333355814640647,
                                                            0.00015403530463724353,
                                                            1.5252733841556773e-05,
                                                            1.3215432535912375e-06,
                                                            1.0178057087733941e-07,
                                                            7.074194297288521e-09,
                                                            4.4558179083360645e-10};
template <>
inline constexpr std::array<float, 12> kExp2Series<float>{1.0F,
                                                          0.6931472067028326F,
                                                          0.24022650922288757F,
                                                          0.05550327226670302F,
                                                          0.009618056678524637F,
                                                          0.0013400428177615838F,
                                                          0.0001546144469856913F};
template <class T>
inline constexpr std::size_t kExp2Terms = sizeof(T) == sizeof(double) ? 12 : 7;

// Adding it rounds to a whole number and leaves that in the lowest bits.
template <class T>
inline constexpr T kRounder = sizeof(T) == sizeof(double) ? T(0x1.8p52) : T(0x1.8p23);
// Below 2^-kDeepest a probability is 0: what scales it stays in the normal range.
template <class T>
inline constexpr T kDeepest = sizeof(T) == sizeof(double) ? T(1020) : T(124);

// Where the pattern is 0, in w = tan^2(angle / 2). The series leave out the factor w of the null - w, so that
// no digit is lost near it.
template <class T>
struct LaneNull {
  T end{};     // nothing is heard from this w on; infinite: the null, if any, lies behind
  T w = T(1);  // and w_rest: the null to twice the precision
  T w_rest{};
  T slope{};          // 0: no such factor
  bool wide = false;  // how to get at w, see half_tangent
  [[nodiscard]] T distance(T at, T at_rest) const { return (w - at * slope) + (w_rest - at_rest * slope); }
};

// A beam as the loops want it, in their own type.
template <class T>
struct LaneBeam {
  BeamForm form = BeamForm::cosine;
  DetectionFormula formula = DetectionFormula::paper;
  std::array<T, BeamSeries::kMost> series_h{};
  std::array<T, BeamSeries::kMost> series_v{};
  std::size_t terms = 1;
  LaneNull<T> null_h, null_v;
  T exponent_per_m{};    // log2(3) over R0, and over what the series leave out
  T most_exponent{};     // PD beyond it is cut to 0
  T farthest_squared{};  // m^2: whatever pattern, PD beyond it is cut to 0; infinite if tags have their own
                         // R0
  T least_squared{}, most_squared{};  // m^2: outside, squares leave the number range and `exact` takes over
  const void* exact_context = nullptr;
  T (*exact)(const void* context, T x, T y, T z, T r0) = nullptr;
};

// Points in the antenna frame, and each tag's R0 (null: the exponent_per_m of the beam holds R0).
template <class T>
struct LanePoints {
  const T* x = nullptr;
  const T* y = nullptr;
  const T* z = nullptr;
  const T* r0 = nullptr;
  std::size_t count = 0;
};

void detection_lanes(const LaneBeam<double>& beam, const LanePoints<double>& points, double* probabilities);
void detection_lanes(const LaneBeam<float>& beam, const LanePoints<float>& points, float* probabilities);
// 2 / (1 + 3^sqrt(x)) of many x = u^2; 0 where x is negative or not a number.
void detection_curve_lanes(const double* x, std::size_t count, double* probabilities);
void detection_curve_lanes(const float* x, std::size_t count, float* probabilities);

// The instruction sets this machine could run the loops with, best first: "AVX3", "AVX2", "SSE4", "NEON".
// Built without Highway: "none".
[[nodiscard]] std::vector<std::string> lane_targets();
// Runs the loops with one of them from now on ("": with the best again), to compare them. For tests; not
// while another thread computes. False: there is no such target here.
bool use_lane_target(std::string_view name);

}  // namespace forager::mocks
