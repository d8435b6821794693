#include "mocks/lane_beam.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hal/units.hpp"

namespace forager::mocks {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

// Where squares and products of four coordinates stay normal numbers.
template <class T>
struct UsualRange;
template <>
struct UsualRange<double> {
  static constexpr double least = 1e-70, most = 1e140;
};
template <>
struct UsualRange<float> {
  static constexpr float least = 1e-9F, most = 1e18F;
};

// A null far behind the antenna shapes nothing in front of it.
bool has_factor(double width_rad) { return width_rad <= 0.8 * hal::kPi; }
double null_value(double width_rad) { return has_factor(width_rad) ? null_of_beam(width_rad).w : 1.0; }

template <class T>
LaneNull<T> null_for(double width_rad, bool cosine) {
  LaneNull<T> null;
  null.end = static_cast<T>(kInf);
  if (!cosine) return null;
  const BeamNull exact = null_of_beam(width_rad);
  if (width_rad < hal::kPi / 2.0) null.end = static_cast<T>(exact.w);
  null.wide = sizeof(T) == sizeof(double) && exact.w > 0.6;  // floats carry what rounding takes
  if (!has_factor(width_rad)) return null;
  null.slope = T(1);
  null.w = static_cast<T>(exact.w);
  null.w_rest = static_cast<T>((exact.w - static_cast<double>(null.w)) + exact.rest);
  return null;
}

bool usable(double width_rad) { return width_rad > 0.0 && width_rad <= hal::kPi; }

template <class T>
void put_series(const BeamSeries& series, std::array<T, BeamSeries::kMost>& out) {
  for (std::size_t i = 0; i < series.terms; ++i) out[i] = static_cast<T>(series.coefficient[i]);
}

}  // namespace

template <class T>
LaneBeam<T> make_lane_beam(bool cosine, double width_h_rad, double width_v_rad) {
  LaneBeam<T> lanes;
  lanes.least_squared = UsualRange<T>::least;
  lanes.most_squared = UsualRange<T>::most;
  if (!usable(width_h_rad) || !usable(width_v_rad)) return lanes;  // w of the nulls is 0: it hears nothing
  constexpr double kRightAngle = hal::kPi / 2.0;
  lanes.form = !cosine                                                    ? BeamForm::gaussian
               : width_h_rad == kRightAngle && width_v_rad == kRightAngle ? BeamForm::algebraic
                                                                          : BeamForm::cosine;
  constexpr double kTolerance = sizeof(T) == sizeof(double) ? 0x1p-57 : 0x1p-28;
  const auto series = [&](double width) {
    return cosine ? cosine_beam_series(width, has_factor(width), kTolerance)
                  : gaussian_beam_series(width, kTolerance);
  };
  const BeamSeries h = series(width_h_rad);
  const BeamSeries v = series(width_v_rad);
  lanes.terms = std::max(h.terms, v.terms);
  put_series(h, lanes.series_h);
  put_series(v, lanes.series_v);
  lanes.null_h = null_for<T>(width_h_rad, cosine);
  lanes.null_v = null_for<T>(width_v_rad, cosine);
  return lanes;
}

template LaneBeam<double> make_lane_beam<double>(bool, double, double);
template LaneBeam<float> make_lane_beam<float>(bool, double, double);

double left_out_of_amplitude(bool cosine, double width_h_rad, double width_v_rad) {
  constexpr double kRightAngle = hal::kPi / 2.0;
  if (!cosine || !usable(width_h_rad) || !usable(width_v_rad)) return 1.0;
  if (width_h_rad == kRightAngle && width_v_rad == kRightAngle) return 1.0;
  return null_value(width_h_rad) * null_value(width_v_rad);
}

}  // namespace forager::mocks
