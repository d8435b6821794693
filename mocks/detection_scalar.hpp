#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "mocks/detection_lanes.hpp"

namespace forager::mocks {

// The loop body of mocks/detection_lanes.hpp for one point at a time: for single pairs, and for machines or
// builds without vectors. It rounds after every product where vector units fuse product and sum.

// 2^-t for 0 <= t <= kDeepest.
template <class T>
[[nodiscard]] T exp2_of_minus(T t) {
  using Bits = std::conditional_t<sizeof(T) == sizeof(double), std::uint64_t, std::uint32_t>;
  constexpr int kMantissa = sizeof(T) == sizeof(double) ? 52 : 23;
  constexpr Bits kOne = std::bit_cast<Bits>(T(1));
  const T shifted = t + kRounder<T>;
  const T r = (shifted - kRounder<T>)-t;
  T sum = kExp2Series<T>[kExp2Terms<T> - 1];
  for (std::size_t i = kExp2Terms<T> - 1; i-- > 0;) sum = sum * r + kExp2Series<T>[i];
  return sum * std::bit_cast<T>(static_cast<Bits>(kOne - (std::bit_cast<Bits>(shifted) << kMantissa)));
}

// 2 / (1 + 2^t), 0 where t is above `most`, negative or not a number.
template <class T>
[[nodiscard]] T detection_of_exponent(T t, T most) {
  if (!(t >= T(0) && t <= most)) return T(0);
  const T tail = exp2_of_minus(t);
  return (tail + tail) / (T(1) + tail);
}

// w = tan^2 of half an angle, and what rounding took from it.
template <class T>
struct HalfTangent {
  T w;
  T rest;
};

// Of the angle between the leg `along` and the hypotenuse. Near the null of a wide beam the difference rounds
// less, near boresight the quotient does.
[[nodiscard]] inline HalfTangent<double> half_tangent(double along, double across, double hypotenuse,
                                                      bool wide) {
  const double sum = hypotenuse + along;
  if (wide) return {(hypotenuse - along) / sum, 0.0};
  const double q = across / sum;
  return {q * q, 0.0};
}

// Both angles of a float: next to the null its roots and quotients would lose more than its answer may.
[[nodiscard]] inline HalfTangent<float> narrowed(const HalfTangent<double>& exact) {
  const auto w = static_cast<float>(exact.w);
  return {w, static_cast<float>(exact.w - static_cast<double>(w))};
}

// Square root of the pattern power; 0 at the nulls and beyond.
template <class T>
[[nodiscard]] T beam_amplitude(const LaneBeam<T>& beam, const HalfTangent<T>& at_h,
                               const HalfTangent<T>& at_v) {
  const T w_h = at_h.w;
  const T w_v = at_v.w;
  if (!(w_h < beam.null_h.end && w_v < beam.null_v.end)) return T(0);
  T h = beam.series_h[beam.terms - 1];
  T v = beam.series_v[beam.terms - 1];
  for (std::size_t i = beam.terms - 1; i-- > 0;) {
    h = h * w_h + beam.series_h[i];
    v = v * w_v + beam.series_v[i];
  }
  if (beam.form == BeamForm::cosine) {
    const T to_null = beam.null_h.distance(w_h, at_h.rest) * beam.null_v.distance(w_v, at_v.rest);
    return to_null > T(0) ? h * v * to_null : T(0);
  }
  const T depth = h + v;
  return depth <= kDeepest<T> ? exp2_of_minus(depth > T(0) ? depth : T(0)) : T(0);
}

// The same towards a point before the antenna whose squares are normal numbers, in its geometry or the
// plugin's.
template <class T>
[[nodiscard]] T pattern_amplitude(const LaneBeam<T>& beam, T x_of_point, T y_of_point, T z_of_point) {
  const double x = x_of_point, y = y_of_point, z = z_of_point;
  const double planar = std::sqrt(x * x + y * y);
  const double range = std::sqrt(x * x + y * y + z * z);
  if (beam.form == BeamForm::algebraic) return static_cast<T>(x / range);
  const HalfTangent<double> h = half_tangent(x, y, planar, beam.null_h.wide);
  const HalfTangent<double> v = beam.formula == DetectionFormula::plugin_as_published
                                    ? half_tangent(x, z, std::sqrt(x * x + z * z), beam.null_v.wide)
                                    : half_tangent(planar, z, range, beam.null_v.wide);
  if constexpr (sizeof(T) == sizeof(double))
    return beam_amplitude(beam, h, v);
  else
    return beam_amplitude(beam, narrowed(h), narrowed(v));
}

// Whether squares of the coordinates leave the range of normal numbers.
template <class T>
[[nodiscard]] bool needs_exact(const LaneBeam<T>& beam, T x, T y, T z) {
  const T planar_squared = x * x + y * y;
  if (!(planar_squared >= beam.least_squared && planar_squared + z * z <= beam.most_squared)) return true;
  return beam.formula == DetectionFormula::plugin_as_published && !(x * x + z * z >= beam.least_squared);
}

template <class T>
[[nodiscard]] T detection_at(const LaneBeam<T>& beam, T x, T y, T z, T r0) {
  const T planar_squared = x * x + y * y;
  const T range_squared = planar_squared + z * z;
  if (!(x > T(0)) || range_squared > beam.farthest_squared) return T(0);
  if (needs_exact(beam, x, y, z)) return beam.exact(beam.exact_context, x, y, z, r0);
  const bool published = beam.formula == DetectionFormula::plugin_as_published;
  T reach = r0;  // R0 times the pattern
  T range{};
  if (beam.form == BeamForm::algebraic) {
    if (beam.formula == DetectionFormula::paper) {
      range = range_squared;
      reach *= x;
    } else if (published) {
      range = std::sqrt(planar_squared) * planar_squared * (x * x + z * z);
      reach *= x * x * (x * x);
    } else {
      range = std::sqrt(range_squared) * range_squared;
      reach *= x * x;
    }
  } else {
    range = std::sqrt(published ? planar_squared : range_squared);
    const T amplitude = pattern_amplitude(beam, x, y, z);
    if (!(amplitude > T(0))) return T(0);
    reach *= beam.formula == DetectionFormula::paper ? amplitude : amplitude * amplitude;
  }
  return detection_of_exponent(range * beam.exponent_per_m / reach, beam.most_exponent);
}

}  // namespace forager::mocks
