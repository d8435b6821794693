#include "mocks/detection_kernel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mocks/detection.hpp"
#include "mocks/detection_scalar.hpp"

namespace forager::mocks {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kLog2Of3 = 1.584962500721156;

struct Named {
  DetectionFormula formula;
  std::string_view name;
};
constexpr Named kFormulas[] = {{DetectionFormula::paper, "paper"},
                               {DetectionFormula::plugin, "plugin"},
                               {DetectionFormula::plugin_as_published, "plugin as published"}};

// u above which PD is below the cut.
double deepest_u(double cut) {
  if (!(cut > 0.0)) return kDeepest<double> / kLog2Of3;
  if (cut >= 1.0) return 0.0;
  return std::min(std::log2(2.0 / cut - 1.0), kDeepest<double>) / kLog2Of3;
}

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
  null.wide = true;
  if (!cosine) return null;
  const BeamNull exact = null_of_beam(width_rad);
  if (width_rad < hal::kPi / 2.0) null.end = static_cast<T>(exact.w);
  null.wide = exact.w > 0.6;
  if (!has_factor(width_rad)) return null;
  null.slope = T(1);
  null.w = static_cast<T>(exact.w);
  null.w_rest = static_cast<T>((exact.w - static_cast<double>(null.w)) + exact.rest);
  return null;
}

}  // namespace

hal::Result<DetectionFormula> detection_formula(std::string_view name) {
  for (const Named& named : kFormulas)
    if (name == named.name) return named.formula;
  return hal::fail(hal::ErrorCode::invalid_argument, "detection", "choose formula",
                   fmt::format("there is no '{}'", name), "There are: paper, plugin, plugin as published.");
}

std::string_view to_string(DetectionFormula formula) {
  return kFormulas[static_cast<std::size_t>(formula)].name;
}

DetectionKernel::DetectionKernel(const DetectionSettings& settings)
    : settings_(settings),
      farthest_r0_(deepest_u(settings.cut)),
      tabulated_(!settings.pattern.beam().has_value()),
      beam_(make_beam<double>(0x1p-57)),
      beam_f32_(make_beam<float>(0x1p-28)) {
  point_to_myself();
}

DetectionKernel::DetectionKernel(const DetectionKernel& other) { *this = other; }

DetectionKernel& DetectionKernel::operator=(const DetectionKernel& other) {
  if (this == &other) return *this;
  settings_ = other.settings_;
  farthest_r0_ = other.farthest_r0_;
  tabulated_ = other.tabulated_;
  beam_ = other.beam_;
  beam_f32_ = other.beam_f32_;
  point_to_myself();
  return *this;
}

void DetectionKernel::point_to_myself() {
  beam_.exact_context = this;
  beam_f32_.exact_context = this;
}

template <class T>
LaneBeam<T> DetectionKernel::make_beam(double tolerance) const {
  LaneBeam<T> lanes;
  lanes.exact = [](const void* self, T x, T y, T z, T r0) {
    return static_cast<T>(static_cast<const DetectionKernel*>(self)->reference({x, y, z}, r0));
  };
  const double most_exponent = std::min(farthest_r0_ * kLog2Of3, static_cast<double>(kDeepest<T>));
  lanes.formula = settings_.formula;
  lanes.exponent_per_m = static_cast<T>(kLog2Of3 / settings_.r0_m);
  lanes.most_exponent = static_cast<T>(most_exponent);
  lanes.least_squared = UsualRange<T>::least;
  lanes.most_squared = UsualRange<T>::most;
  // A tag's own R0 may be larger than the common one; then only the exponent says what is too far.
  lanes.farthest_squared = static_cast<T>(kInf);
  const auto beam = settings_.pattern.beam();
  const bool usable = beam && beam->width_h_rad > 0.0 && beam->width_h_rad <= hal::kPi &&
                      beam->width_v_rad > 0.0 && beam->width_v_rad <= hal::kPi && settings_.r0_m > 0.0 &&
                      std::isfinite(settings_.r0_m);
  if (!usable) return lanes;  // w of the nulls is 0: it hears nothing
  const bool cosine = beam->shape == AntennaPattern::Shape::cosine_squared;
  constexpr double kRightAngle = hal::kPi / 2.0;
  lanes.form = !cosine                                                                ? BeamForm::gaussian
               : beam->width_h_rad == kRightAngle && beam->width_v_rad == kRightAngle ? BeamForm::algebraic
                                                                                      : BeamForm::cosine;
  const auto series = [&](double width) {
    return cosine ? cosine_beam_series(width, has_factor(width), tolerance)
                  : gaussian_beam_series(width, tolerance);
  };
  const BeamSeries h = series(beam->width_h_rad);
  const BeamSeries v = series(beam->width_v_rad);
  lanes.terms = std::max(h.terms, v.terms);
  const auto narrow = [](double value) { return static_cast<T>(value); };
  std::transform(h.coefficient.begin(), h.coefficient.end(), lanes.series_h.begin(), narrow);
  std::transform(v.coefficient.begin(), v.coefficient.end(), lanes.series_v.begin(), narrow);
  std::fill(lanes.series_h.begin() + static_cast<std::ptrdiff_t>(h.terms), lanes.series_h.end(), T(0));
  std::fill(lanes.series_v.begin() + static_cast<std::ptrdiff_t>(v.terms), lanes.series_v.end(), T(0));
  lanes.null_h = null_for<T>(beam->width_h_rad, cosine);
  lanes.null_v = null_for<T>(beam->width_v_rad, cosine);
  if (lanes.form != BeamForm::cosine) return lanes;
  const double factors = null_value(beam->width_h_rad) * null_value(beam->width_v_rad);
  const bool squared = settings_.formula != DetectionFormula::paper;
  lanes.exponent_per_m = static_cast<T>(kLog2Of3 / settings_.r0_m * (squared ? factors * factors : factors));
  return lanes;
}

double DetectionKernel::reference(hal::Vec3 p, double r0_factor) const {
  const bool published = settings_.formula == DetectionFormula::plugin_as_published;
  // Its elevation is that of a point without y, and its range that of one without z.
  const double power =
      published ? settings_.pattern.power({p.x, p.y, 0.0}) * settings_.pattern.power({p.x, 0.0, p.z})
                : settings_.pattern.power(p);
  const double range = published ? std::hypot(p.x, p.y) : std::hypot(p.x, p.y, p.z);
  const double exponent =
      settings_.formula == DetectionFormula::paper ? kPaperPatternExponent : kPluginPatternExponent;
  const double u = normalised_range(range, settings_.r0_m * r0_factor, power, exponent);
  return u <= farthest_r0_ ? detection_probability_compensated_u(u) : 0.0;
}

double DetectionKernel::probability(hal::Vec3 p, double r0_factor) const {
  return tabulated_ ? reference(p, r0_factor) : detection_at(beam_, p.x, p.y, p.z, r0_factor);
}

template <class T>
void DetectionKernel::run(const LaneBeam<T>& beam, std::span<const T> x, std::span<const T> y,
                          std::span<const T> z, std::span<T> results, std::span<const T> r0_factor) const {
  const std::size_t count = std::min(
      {x.size(), y.size(), z.size(), results.size(), r0_factor.empty() ? x.size() : r0_factor.size()});
  if (!tabulated_) {
    detection_lanes(beam,
                    {x.data(), y.data(), z.data(), r0_factor.empty() ? nullptr : r0_factor.data(), count},
                    results.data());
    return;
  }
  for (std::size_t i = 0; i < count; ++i)
    results[i] = static_cast<T>(
        reference({x[i], y[i], z[i]}, r0_factor.empty() ? 1.0 : static_cast<double>(r0_factor[i])));
}

void DetectionKernel::probabilities(std::span<const double> x, std::span<const double> y,
                                    std::span<const double> z, std::span<double> results,
                                    std::span<const double> r0_factor) const {
  run(beam_, x, y, z, results, r0_factor);
}

void DetectionKernel::probabilities(std::span<const float> x, std::span<const float> y,
                                    std::span<const float> z, std::span<float> results,
                                    std::span<const float> r0_factor) const {
  run(beam_f32_, x, y, z, results, r0_factor);
}

}  // namespace forager::mocks
