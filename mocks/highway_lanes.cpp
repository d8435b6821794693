// The loops of mocks/detection_lanes.hpp, compiled once for every instruction set Highway knows for this
// processor family and picked at run time. Every lane computes by itself and in the same order, so where a
// point lies in the arrays and how wide the vectors are makes no difference; only whether products and sums
// are fused does (SSE: no; AVX2, AVX-512, NEON: yes).
// Vectors of unknown length cannot be members of a class: not those of ARM's SVE.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mocks/highway_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>  // wants to come after foreach_target.h

#include "mocks/detection_lanes.hpp"
#include "mocks/detection_scalar.hpp"

HWY_BEFORE_NAMESPACE();
namespace forager::mocks {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// 2^-t for 0 <= t <= kDeepest; other lanes get anything.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V power_of_minus(D d, V t) {
  using T = hn::TFromD<D>;
  const hn::RebindToUnsigned<D> bits;
  const V rounder = hn::Set(d, kRounder<T>);
  const V shifted = hn::Add(t, rounder);
  const V r = hn::Sub(hn::Sub(shifted, rounder), t);
  V sum = hn::Set(d, kExp2Series<T>[kExp2Terms<T> - 1]);
  for (std::size_t i = kExp2Terms<T> - 1; i-- > 0;) sum = hn::MulAdd(sum, r, hn::Set(d, kExp2Series<T>[i]));
  constexpr int kMantissa = sizeof(T) == sizeof(double) ? 52 : 23;
  const auto scale =
      hn::Sub(hn::BitCast(bits, hn::Set(d, T(1))), hn::ShiftLeft<kMantissa>(hn::BitCast(bits, shifted)));
  return hn::Mul(sum, hn::BitCast(d, scale));
}

// 2 / (1 + 2^t) where `seen`, else 0.
template <class D, class V = hn::Vec<D>, class M>
HWY_INLINE V detection_of_exponent(D d, M seen, V t) {
  const V tail = power_of_minus(d, t);
  return hn::IfThenElseZero(seen, hn::Div(hn::Add(tail, tail), hn::Add(hn::Set(d, hn::TFromD<D>(1)), tail)));
}

// One vector of points.
template <class T>
struct Loop {
  using D = hn::ScalableTag<T>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;

  const LaneBeam<T>& beam;
  D d{};

  // Range over R0 times pattern, for an antenna whose amplitude is x/R: no series.
  template <DetectionFormula kFormula>
  HWY_INLINE V algebraic(V x, V z, V planar_squared, V range_squared, V k, V r0) const {
    if constexpr (kFormula == DetectionFormula::paper)
      return hn::Div(hn::Mul(range_squared, k), hn::Mul(r0, x));
    const V xx = hn::Mul(x, x);
    if constexpr (kFormula == DetectionFormula::plugin)
      return hn::Div(hn::Mul(hn::Mul(hn::Sqrt(range_squared), range_squared), k), hn::Mul(r0, xx));
    const V upright_squared = hn::MulAdd(z, z, xx);
    const V cube = hn::Mul(hn::Sqrt(planar_squared), planar_squared);
    return hn::Div(hn::Mul(hn::Mul(cube, upright_squared), k), hn::Mul(r0, hn::Mul(xx, xx)));
  }

  // A number and what rounding took from it. Doubles do without.
  struct Pair {
    V value;
    V rest;
  };
  static constexpr bool kCarries = sizeof(T) < sizeof(double);

  // sum + leg^2, exact but for the rounding of the rest (Knuth's sum, Dekker's product by fma).
  HWY_INLINE Pair plus_square(Pair sum, V leg) const {
    if constexpr (!kCarries) return {hn::MulAdd(leg, leg, sum.value), sum.rest};
    const V square = hn::Mul(leg, leg);
    const V total = hn::Add(sum.value, square);
    const V part = hn::Sub(total, sum.value);
    const V lost = hn::Add(hn::Sub(sum.value, hn::Sub(total, part)), hn::Sub(square, part));
    return {total, hn::Add(lost, hn::Add(hn::MulSub(leg, leg, square), sum.rest))};
  }
  HWY_INLINE Pair root(Pair square) const {
    const V value = hn::Sqrt(square.value);
    if constexpr (!kCarries) return {value, square.rest};
    const V remainder = hn::Add(hn::NegMulAdd(value, value, square.value), square.rest);
    return {value, hn::Div(remainder, hn::Add(value, value))};
  }
  // tan^2 of half the angle between the leg `along` and the hypotenuse.
  HWY_INLINE Pair half_tangent(Pair along, V across, Pair hypotenuse, bool wide) const {
    const V sum = hn::Add(hypotenuse.value, along.value);
    if constexpr (!kCarries) {
      if (wide) return {hn::Div(hn::Sub(hypotenuse.value, along.value), sum), along.rest};
      const V q = hn::Div(across, sum);
      return {hn::Mul(q, q), along.rest};
    }
    const V sum_rest =
        hn::Add(hn::Sub(along.value, hn::Sub(sum, hypotenuse.value)), hn::Add(along.rest, hypotenuse.rest));
    const V inverse = hn::Div(hn::Set(d, T(1)), sum);
    const V q = hn::Mul(across, inverse);
    const V q_rest = hn::Mul(hn::NegMulAdd(q, sum_rest, hn::NegMulAdd(q, sum, across)), inverse);
    const V w = hn::Mul(q, q);
    return {w, hn::MulAdd(hn::Add(q, q), q_rest, hn::MulSub(q, q, w))};
  }
  HWY_INLINE V to_null(const Pair& at, const LaneNull<T>& null) const {
    const V slope = hn::Set(d, null.slope);
    V rest = hn::Set(d, null.w_rest);
    if constexpr (kCarries) rest = hn::NegMulAdd(at.rest, slope, rest);
    return hn::Add(hn::NegMulAdd(at.value, slope, hn::Set(d, null.w)), rest);
  }

  template <BeamForm kForm>
  HWY_INLINE V amplitude(const Pair& at_h, const Pair& at_v, M& seen) const {
    const V w_h = at_h.value;
    const V w_v = at_v.value;
    seen = hn::And(
        seen, hn::And(hn::Lt(w_h, hn::Set(d, beam.null_h.end)), hn::Lt(w_v, hn::Set(d, beam.null_v.end))));
    V h = hn::Set(d, beam.series_h[beam.terms - 1]);
    V v = hn::Set(d, beam.series_v[beam.terms - 1]);
    for (std::size_t i = beam.terms - 1; i-- > 0;) {
      h = hn::MulAdd(h, w_h, hn::Set(d, beam.series_h[i]));
      v = hn::MulAdd(v, w_v, hn::Set(d, beam.series_v[i]));
    }
    if constexpr (kForm == BeamForm::cosine) {
      return hn::Mul(hn::Mul(h, v), hn::Mul(to_null(at_h, beam.null_h), to_null(at_v, beam.null_v)));
    }
    const V depth = hn::Max(hn::Add(h, v), hn::Zero(d));
    seen = hn::And(seen, hn::Le(depth, hn::Set(d, kDeepest<T>)));
    return power_of_minus(d, depth);
  }

  template <BeamForm kForm, DetectionFormula kFormula>
  HWY_INLINE V by_series(V x, V y, V z, V k, V r0, M& seen) const {
    const V zero = hn::Zero(d);
    const Pair ahead{x, zero};
    const Pair ahead_squared = plus_square({zero, zero}, x);
    const Pair planar_squared = plus_square(ahead_squared, y);
    const Pair planar = root(planar_squared);
    const Pair at_h = half_tangent(ahead, y, planar, beam.null_h.wide);
    V range = planar.value;
    V g;
    if constexpr (kFormula == DetectionFormula::plugin_as_published) {
      const Pair upright = root(plus_square(ahead_squared, z));
      g = amplitude<kForm>(at_h, half_tangent(ahead, z, upright, beam.null_v.wide), seen);
    } else {
      const Pair whole = root(plus_square(planar_squared, z));
      g = amplitude<kForm>(at_h, half_tangent(planar, z, whole, beam.null_v.wide), seen);
      range = whole.value;
    }
    if constexpr (kFormula != DetectionFormula::paper) g = hn::Mul(g, g);
    return hn::Div(hn::Mul(range, k), hn::Mul(r0, g));
  }

  // PD of one vector; `odd` gets the lanes that need the exact function.
  template <BeamForm kForm, DetectionFormula kFormula>
  HWY_INLINE V step(V x, V y, V z, V r0, M& odd) const {
    const V k = hn::Set(d, beam.exponent_per_m);
    const V planar_squared = hn::MulAdd(y, y, hn::Mul(x, x));
    const V range_squared = hn::MulAdd(z, z, planar_squared);
    const M ahead = hn::Gt(x, hn::Zero(d));
    M seen = hn::And(ahead, hn::Le(range_squared, hn::Set(d, beam.farthest_squared)));
    M usual = hn::And(hn::Ge(planar_squared, hn::Set(d, beam.least_squared)),
                      hn::Le(range_squared, hn::Set(d, beam.most_squared)));
    if constexpr (kFormula == DetectionFormula::plugin_as_published)
      usual = hn::And(usual, hn::Ge(hn::MulAdd(z, z, hn::Mul(x, x)), hn::Set(d, beam.least_squared)));
    odd = hn::AndNot(usual, ahead);
    if (hn::AllFalse(d, seen)) return hn::Zero(d);
    V t;
    if constexpr (kForm == BeamForm::algebraic)
      t = algebraic<kFormula>(x, z, planar_squared, range_squared, k, r0);
    else
      t = by_series<kForm, kFormula>(x, y, z, k, r0, seen);
    // Rounding may leave a pattern just short of its null below 0.
    seen = hn::And(seen, hn::And(hn::Ge(t, hn::Zero(d)), hn::Le(t, hn::Set(d, beam.most_exponent))));
    if (hn::AllFalse(d, seen)) return hn::Zero(d);
    // Powers that nobody wants would be denormal, and those are slow.
    return detection_of_exponent(d, seen, hn::IfThenElseZero(seen, t));
  }

  HWY_NOINLINE void mend(const LanePoints<T>& points, std::size_t first, std::size_t count, T* out) const {
    for (std::size_t i = first; i < first + count; ++i) {
      const T x = points.x[i], y = points.y[i], z = points.z[i];
      if (x > T(0) && needs_exact(beam, x, y, z))
        out[i] = beam.exact(beam.exact_context, x, y, z, points.r0 != nullptr ? points.r0[i] : T(1));
    }
  }

  template <BeamForm kForm, DetectionFormula kFormula>
  void whole_vectors(const LanePoints<T>& points, T* out) const {
    const std::size_t lanes = hn::Lanes(d);
    const V one = hn::Set(d, T(1));
    for (std::size_t i = 0; i + lanes <= points.count; i += lanes) {
      const V r0 = points.r0 != nullptr ? hn::LoadU(d, points.r0 + i) : one;
      M odd;
      const V p = step<kForm, kFormula>(hn::LoadU(d, points.x + i), hn::LoadU(d, points.y + i),
                                        hn::LoadU(d, points.z + i), r0, odd);
      hn::StoreU(p, d, out + i);
      if (!hn::AllFalse(d, odd)) mend(points, i, lanes, out);
    }
  }

  template <BeamForm kForm>
  void by_formula(const LanePoints<T>& points, T* out) const {
    switch (beam.formula) {
      case DetectionFormula::paper:
        return whole_vectors<kForm, DetectionFormula::paper>(points, out);
      case DetectionFormula::plugin:
        return whole_vectors<kForm, DetectionFormula::plugin>(points, out);
      case DetectionFormula::plugin_as_published:
        return whole_vectors<kForm, DetectionFormula::plugin_as_published>(points, out);
    }
  }

  void by_form(const LanePoints<T>& points, T* out) const {
    switch (beam.form) {
      case BeamForm::cosine:
        return by_formula<BeamForm::cosine>(points, out);
      case BeamForm::gaussian:
        return by_formula<BeamForm::gaussian>(points, out);
      case BeamForm::algebraic:
        return by_formula<BeamForm::algebraic>(points, out);
    }
  }

  // What is left over fills a vector of its own, with points behind the antenna.
  void all(const LanePoints<T>& points, T* out) const {
    by_form(points, out);
    const std::size_t lanes = hn::Lanes(d);
    const std::size_t rest = points.count % lanes;
    if (rest == 0) return;
    constexpr std::size_t kMostLanes = HWY_MAX_BYTES / sizeof(T);
    T x[kMostLanes], y[kMostLanes], z[kMostLanes], r0[kMostLanes], p[kMostLanes];
    const std::size_t first = points.count - rest;
    for (std::size_t i = 0; i < lanes; ++i) {
      const bool there = i < rest;
      x[i] = there ? points.x[first + i] : T(-1);
      y[i] = there ? points.y[first + i] : T(0);
      z[i] = there ? points.z[first + i] : T(0);
      r0[i] = there && points.r0 != nullptr ? points.r0[first + i] : T(1);
    }
    by_form({x, y, z, r0, lanes}, p);
    for (std::size_t i = 0; i < rest; ++i) out[first + i] = p[i];
  }
};

template <class T>
HWY_INLINE void curve(const T* x, std::size_t count, T* out) {
  const hn::ScalableTag<T> d;
  const std::size_t lanes = hn::Lanes(d);
  const auto log2_of_3 = hn::Set(d, T(1.584962500721156));
  const auto most = hn::Set(d, kDeepest<T>);
  constexpr std::size_t kMostLanes = HWY_MAX_BYTES / sizeof(T);
  T in[kMostLanes], result[kMostLanes];
  for (std::size_t i = 0; i < count; i += lanes) {
    const bool whole = i + lanes <= count;
    for (std::size_t j = 0; !whole && j < lanes; ++j) in[j] = i + j < count ? x[i + j] : T(0);
    // A root of a negative number is none, and no number is at most anything.
    const auto t = hn::Mul(hn::Sqrt(hn::LoadU(d, whole ? x + i : in)), log2_of_3);
    hn::StoreU(detection_of_exponent(d, hn::Le(t, most), t), d, whole ? out + i : result);
    for (std::size_t j = 0; !whole && i + j < count; ++j) out[i + j] = result[j];
  }
}

// One name for each type: Highway's table of targets takes plain functions.
void points_f64(const LaneBeam<double>& beam, const LanePoints<double>& points, double* out) {
  Loop<double>{beam}.all(points, out);
}
void points_f32(const LaneBeam<float>& beam, const LanePoints<float>& points, float* out) {
  Loop<float>{beam}.all(points, out);
}
void curve_f64(const double* x, std::size_t count, double* out) { curve(x, count, out); }
void curve_f32(const float* x, std::size_t count, float* out) { curve(x, count, out); }

}  // namespace HWY_NAMESPACE
}  // namespace forager::mocks
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace forager::mocks {

HWY_EXPORT(points_f64);
HWY_EXPORT(points_f32);
HWY_EXPORT(curve_f64);
HWY_EXPORT(curve_f32);

void detection_lanes(const LaneBeam<double>& beam, const LanePoints<double>& points, double* probabilities) {
  HWY_DYNAMIC_DISPATCH(points_f64)(beam, points, probabilities);
}
void detection_lanes(const LaneBeam<float>& beam, const LanePoints<float>& points, float* probabilities) {
  HWY_DYNAMIC_DISPATCH(points_f32)(beam, points, probabilities);
}
void detection_curve_lanes(const double* x, std::size_t count, double* probabilities) {
  HWY_DYNAMIC_DISPATCH(curve_f64)(x, count, probabilities);
}
void detection_curve_lanes(const float* x, std::size_t count, float* probabilities) {
  HWY_DYNAMIC_DISPATCH(curve_f32)(x, count, probabilities);
}

}  // namespace forager::mocks
#endif  // HWY_ONCE
