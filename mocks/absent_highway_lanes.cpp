// Built without Highway: one point at a time.
#include <algorithm>
#include <cmath>

#include "mocks/detection_lanes.hpp"
#include "mocks/detection_scalar.hpp"

namespace forager::mocks {
namespace {

template <class T>
void run(const LaneBeam<T>& beam, const LanePoints<T>& points, T* probabilities) {
  for (std::size_t i = 0; i < points.count; ++i)
    probabilities[i] =
        detection_at(beam, points.x[i], points.y[i], points.z[i], points.r0 != nullptr ? points.r0[i] : T(1));
}

template <class T>
void run_curve(const T* x, std::size_t count, T* probabilities) {
  constexpr T kLog2Of3 = T(1.584962500721156);
  std::transform(x, x + count, probabilities,
                 [](T value) { return detection_of_exponent(std::sqrt(value) * kLog2Of3, kDeepest<T>); });
}

}  // namespace

void detection_lanes(const LaneBeam<double>& beam, const LanePoints<double>& points, double* probabilities) {
  run(beam, points, probabilities);
}
void detection_lanes(const LaneBeam<float>& beam, const LanePoints<float>& points, float* probabilities) {
  run(beam, points, probabilities);
}
void detection_curve_lanes(const double* x, std::size_t count, double* probabilities) {
  run_curve(x, count, probabilities);
}
void detection_curve_lanes(const float* x, std::size_t count, float* probabilities) {
  run_curve(x, count, probabilities);
}

std::vector<std::string> lane_targets() { return {"none"}; }

bool use_lane_target(std::string_view name) { return name.empty() || name == "none"; }

}  // namespace forager::mocks
