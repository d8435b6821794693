#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "boards/accuracy_row.hpp"
#include "boards/detection_truth.hpp"
#include "hal/random.hpp"
#include "mocks/detection.hpp"
#include "mocks/detection_kernel.hpp"

namespace forager::boards {
namespace {

constexpr double kCuts[] = {0.0, 1e-12, 1e-9, 1e-6};
// Relative errors count where a probability is not lost among a million tags anyway.
constexpr double kWorthRelating = 1e-9;

void note(AccuracyRow& row, double answer, double exact) {
  const double off = std::abs(answer - exact);
  ++row.asked;
  if (!(answer >= 0.0 && answer <= 1.0)) {
    ++row.failures;
    return;
  }
  row.max_abs_error = std::max(row.max_abs_error, off);
  if (exact >= kWorthRelating) row.max_rel_error = std::max(row.max_rel_error, off / exact);
}

// f(x) = 2 / (1 + 3^sqrt x) by itself.
std::vector<AccuracyRow> curve_rows(std::uint64_t seed, std::size_t count) {
  struct Points {
    std::vector<double> x, p;
    std::vector<float> x_f32, p_f32;
  };
  const auto points = std::make_shared<Points>();
  hal::Random random(seed);
  for (std::size_t i = 0; i < count; ++i) {
    // A float is a double, so that all of them answer for the same x.
    points->x_f32.push_back(static_cast<float>(std::pow(10.0, random.uniform(-8.0, 4.0))));
    points->x.push_back(static_cast<double>(points->x_f32.back()));
  }
  points->p.resize(count);
  points->p_f32.resize(count);
  std::vector<Wide> exact;
  std::transform(points->x.begin(), points->x.end(), std::back_inserter(exact), exact_curve);

  std::vector<AccuracyRow> rows;
  const auto add = [&](const char* variant, auto work, auto answer) {
    AccuracyRow row{
        .name = "f(x) = 2/(1+3^sqrt x), x of 1e-8..1e4", .variant = variant, .reference = "f(x) to 100 bits"};
    row.work = [points, work] { work(*points); };
    row.work();
    for (std::size_t i = 0; i < count; ++i) note(row, answer(i), exact[i].rounded());
    row.items = static_cast<double>(count);
    rows.push_back(std::move(row));
  };
  const auto f64 = [points](std::size_t i) { return points->p[i]; };
  add(
      "f32, vectors",
      [](Points& p) { mocks::detection_curve_lanes(p.x_f32.data(), p.x.size(), p.p_f32.data()); },
      [points](std::size_t i) { return static_cast<double>(points->p_f32[i]); });
  add(
      "f64, vectors", [](Points& p) { mocks::detection_curve_lanes(p.x.data(), p.x.size(), p.p.data()); },
      f64);
  const auto each = [](double (*f)(double)) {
    return [f](Points& p) { std::transform(p.x.begin(), p.x.end(), p.p.begin(), f); };
  };
  add("f64, libm exp", each([](double x) { return mocks::detection_probability(std::sqrt(x)); }), f64);
  add("f64, libm pow as written", each([](double x) { return 2.0 / (1.0 + std::pow(3.0, std::sqrt(x))); }),
      f64);
  add("f64, 1 - tanh", each([](double x) { return 1.0 - std::tanh(0.5 * std::log(3.0) * std::sqrt(x)); }),
      f64);
  add("compensated", each(mocks::detection_probability_compensated), f64);
  return rows;
}

// Range, pattern and curve of tags around one antenna.
struct Pairs {
  std::vector<double> x, y, z, p;
  std::vector<float> x_f32, y_f32, z_f32, p_f32;
};

std::shared_ptr<Pairs> pairs_around(std::uint64_t seed, std::size_t count) {
  auto pairs = std::make_shared<Pairs>();
  hal::Random random(seed);
  const auto fill = [&](std::vector<float>& f32, std::vector<double>& f64) {
    for (std::size_t i = 0; i < count; ++i) {
      f32.push_back(static_cast<float>(random.uniform(-8.0, 8.0)));
      f64.push_back(static_cast<double>(f32.back()));
    }
  };
  fill(pairs->x_f32, pairs->x);
  fill(pairs->y_f32, pairs->y);
  fill(pairs->z_f32, pairs->z);
  pairs->p.resize(count);
  pairs->p_f32.resize(count);
  return pairs;
}

std::vector<AccuracyRow> pair_rows(double width_deg, const std::shared_ptr<Pairs>& pairs) {
  constexpr double kR0_m = 2.4;
  const double width = hal::deg_to_rad(width_deg);
  std::vector<double> exact;
  for (std::size_t i = 0; i < pairs->x.size(); ++i)
    exact.push_back(exact_detection({pairs->x[i], pairs->y[i], pairs->z[i]}, {width, width, kR0_m}));

  std::vector<AccuracyRow> rows;
  const auto add = [&](const char* way, double cut, auto work, auto answer) {
    AccuracyRow row{.name = fmt::format("PD of tag and antenna, {} degrees", width_deg),
                    .variant = fmt::format("{}, cut {:g}", way, cut),
                    .reference = "whole formula to 100 bits, no cut"};
    const mocks::DetectionKernel kernel(
        {mocks::AntennaPattern::cosine_squared(width, width), kR0_m, mocks::DetectionFormula::paper, cut});
    row.work = [pairs, kernel, work] { work(*pairs, kernel); };
    row.work();
    for (std::size_t i = 0; i < exact.size(); ++i) note(row, answer(i), exact[i]);
    row.items = static_cast<double>(exact.size());
    rows.push_back(std::move(row));
  };
  using mocks::DetectionKernel;
  for (const double cut : kCuts) {
    add(
        "f32", cut,
        [](Pairs& p, const DetectionKernel& k) { k.probabilities(p.x_f32, p.y_f32, p.z_f32, p.p_f32); },
        [&](std::size_t i) { return static_cast<double>(pairs->p_f32[i]); });
    const auto f64 = [&](std::size_t i) { return pairs->p[i]; };
    add(
        "f64", cut, [](Pairs& p, const DetectionKernel& k) { k.probabilities(p.x, p.y, p.z, p.p); }, f64);
    add(
        "compensated", cut,
        [](Pairs& p, const DetectionKernel& k) {
          for (std::size_t i = 0; i < p.x.size(); ++i) p.p[i] = k.reference({p.x[i], p.y[i], p.z[i]});
        },
        f64);
  }
  return rows;
}

}  // namespace

std::vector<AccuracyRow> accuracy_detection(const AccuracyOptions& options) {
  const auto count = std::max<std::size_t>(64, static_cast<std::size_t>(16384.0 * options.effort));
  std::vector<AccuracyRow> rows = curve_rows(options.seed, count);
  const auto pairs = pairs_around(options.seed, count);
  for (const double width_deg : {70.0, 90.0})
    for (AccuracyRow& row : pair_rows(width_deg, pairs)) rows.push_back(std::move(row));
  return rows;
}

}  // namespace forager::boards
