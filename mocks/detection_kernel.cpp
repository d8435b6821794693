#include "mocks/detection_kernel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mocks/detection.hpp"
#include "mocks/detection_scalar.hpp"
#include "mocks/lane_beam.hpp"

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
      exact_pattern_(settings.pattern.with(PatternArithmetic::trigonometry)),
      farthest_r0_(deepest_u(settings.cut)),
      tabulated_(!settings.pattern.beam().has_value()),
      beam_(make_beam<double>()),
      beam_f32_(make_beam<float>()) {
  point_to_myself();
}

DetectionKernel::DetectionKernel(const DetectionKernel& other) { *this = other; }

DetectionKernel& DetectionKernel::operator=(const DetectionKernel& other) {
  if (this == &other) return *this;
  settings_ = other.settings_;
  exact_pattern_ = other.exact_pattern_;
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
LaneBeam<T> DetectionKernel::make_beam() const {
  const auto beam = settings_.pattern.beam();
  const bool reaches = settings_.r0_m > 0.0 && std::isfinite(settings_.r0_m);
  const bool cosine = beam && beam->shape == AntennaPattern::Shape::cosine_squared;
  const double width_h = beam && reaches ? beam->width_h_rad : 0.0;
  const double width_v = beam && reaches ? beam->width_v_rad : 0.0;
  LaneBeam<T> lanes = make_lane_beam<T>(cosine, width_h, width_v);
  lanes.exact = [](const void* self, T x, T y, T z, T r0) {
    return static_cast<T>(static_cast<const DetectionKernel*>(self)->reference({x, y, z}, r0));
  };
  lanes.formula = settings_.formula;
  const double left_out = left_out_of_amplitude(cosine, width_h, width_v);
  lanes.exponent_per_m =
      static_cast<T>(kLog2Of3 / settings_.r0_m *
                     (settings_.formula == DetectionFormula::paper ? left_out : left_out * left_out));
  lanes.most_exponent = static_cast<T>(std::min(farthest_r0_ * kLog2Of3, static_cast<double>(kDeepest<T>)));
  // A tag's own R0 may be larger than the common one; only the exponent says what is too far.
  lanes.farthest_squared = static_cast<T>(kInf);
  return lanes;
}

double DetectionKernel::reference(hal::Vec3 p, double r0_factor) const {
  const bool published = settings_.formula == DetectionFormula::plugin_as_published;
  // Its elevation is that of a point without y, and its range that of one without z.
  const double power = published
                           ? exact_pattern_.power({p.x, p.y, 0.0}) * exact_pattern_.power({p.x, 0.0, p.z})
                           : exact_pattern_.power(p);
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
