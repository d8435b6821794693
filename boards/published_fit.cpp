#include "boards/published_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "boards/simplex_search.hpp"

namespace forager::boards {
namespace {

constexpr std::size_t kParameters = 3;
constexpr const char* kNames[kParameters] = {"r0_m", "spread_db", "rician_k_db"};
constexpr const char* kUnits[kParameters] = {"m", "dB", "dB"};
constexpr double kStep[kParameters] = {0.06, 0.4, 2.0};  // ln m, dB, dB
constexpr double kLowest[kParameters] = {-3.0, 0.0, -10.0};
constexpr double kHighest[kParameters] = {3.5, 12.0, 40.0};
constexpr double kHopeless = 1e9;
constexpr int kMostSteps = 6;

using Point = std::array<double, kParameters>;
using Matrix = std::array<std::array<double, kParameters>, kParameters>;

// 97.5 % of Student's t, 0.3 % high at 3 degrees of freedom and better beyond (Cornish-Fisher).
double student_975(double freedom) {
  constexpr double z = 1.959963984540054;
  const double z3 = z * z * z;
  return z + (z3 + z) / (4.0 * freedom) +
         (5.0 * z3 * z * z + 16.0 * z3 + 3.0 * z) / (96.0 * freedom * freedom) +
         (3.0 * z3 * z3 * z + 19.0 * z3 * z * z + 17.0 * z3 - 15.0 * z) /
             (384.0 * freedom * freedom * freedom);
}

// Gauss-Jordan; nothing if a pivot vanishes beside the largest.
std::optional<Matrix> inverse(Matrix m) {
  Matrix out{};
  double largest = 0.0;
  for (std::size_t i = 0; i < kParameters; ++i) {
    out[i][i] = 1.0;
    largest = std::max(largest, std::abs(m[i][i]));
  }
  for (std::size_t i = 0; i < kParameters; ++i) {
    if (!(std::abs(m[i][i]) > 1e-9 * largest)) return std::nullopt;
    const double pivot = m[i][i];
    for (std::size_t j = 0; j < kParameters; ++j) {
      m[i][j] /= pivot;
      out[i][j] /= pivot;
    }
    for (std::size_t k = 0; k < kParameters; ++k) {
      if (k == i) continue;
      const double factor = m[k][i];
      for (std::size_t j = 0; j < kParameters; ++j) {
        m[k][j] -= factor * m[i][j];
        out[k][j] -= factor * out[i][j];
      }
    }
  }
  return out;
}

double squares_of(const std::vector<double>& differences) {
  double sum = 0.0;
  for (const double d : differences) sum += d * d;
  return sum;
}

// Where the squares would be least if the figures were linear, held back by `damping` of the information.
std::optional<Point> levenberg(const Point& at, const std::vector<double>& here,
                               const std::array<std::vector<double>, kParameters>& slopes, double damping) {
  Matrix information{};
  Point pull{};
  for (std::size_t i = 0; i < kParameters; ++i)
    for (std::size_t f = 0; f < here.size(); ++f) {
      pull[i] -= slopes[i][f] * here[f] * kStep[i];
      for (std::size_t j = 0; j < kParameters; ++j)
        information[i][j] += slopes[i][f] * slopes[j][f] * kStep[i] * kStep[j];
    }
  double largest = 0.0;
  for (std::size_t i = 0; i < kParameters; ++i) largest = std::max(largest, information[i][i]);
  for (std::size_t i = 0; i < kParameters; ++i) information[i][i] += damping * largest;
  const auto inverted = inverse(information);
  if (!inverted) return std::nullopt;
  Point next = at;
  for (std::size_t i = 0; i < kParameters; ++i) {
    double shift = 0.0;
    for (std::size_t j = 0; j < kParameters; ++j) shift += (*inverted)[i][j] * pull[j];
    // Farther than this nothing is linear.
    next[i] = std::clamp(at[i] + kStep[i] * std::clamp(shift, -8.0, 8.0), kLowest[i], kHighest[i]);
  }
  return next;
}

class Fit {
 public:
  explicit Fit(const PublishedFitOptions& options) : options_(options) {
    reproduce_.folder = options.folder;
    reproduce_.seeds = options.seeds;
    reproduce_.runs = options.runs;
    if (reproduce_.runs.empty())
      for (const PublishedRun& run : published_runs())
        if (run.in_fit) reproduce_.runs.emplace_back(run.run);
  }

  // Median coverages less published ones, points.
  hal::Result<std::vector<double>> differences(Point at) {
    for (std::size_t i = 0; i < kParameters; ++i) at[i] = std::clamp(at[i], kLowest[i], kHighest[i]);
    reproduce_.change = [at](Scene& scene) {
      scene.world.radio.r0_m = std::exp(at[0]);
      scene.world.radio.spread_db = at[1];
      scene.world.radio.rician_k_db = at[2];
    };
    auto result = reproduce(reproduce_);
    if (!result) return hal::fail(std::move(result).error());
    ++evaluations_;
    last_ = std::move(*result);
    std::vector<double> out;
    for (const ReproducedRun& run : last_.runs)
      if (const auto difference = run.difference_points()) out.push_back(*difference);
    if (options_.progress) options_.progress(evaluations_, last_.rms_points().value_or(0.0));
    return out;
  }

  // Derivatives of all figures at a point, by differences: forwards, or to both sides (twice the price).
  hal::Result<std::array<std::vector<double>, kParameters>> slopes(const Point& at,
                                                                   const std::vector<double>* here) {
    const auto value_at = [&](const Point& point) -> hal::Result<std::vector<double>> {
      if (here != nullptr && point == at) return *here;
      return differences(point);
    };
    std::array<std::vector<double>, kParameters> out;
    for (std::size_t i = 0; i < kParameters; ++i) {
      Point up = at;
      Point down = at;
      up[i] = std::min(up[i] + kStep[i], kHighest[i]);
      if (here == nullptr || up[i] == at[i]) down[i] = std::max(down[i] - kStep[i], kLowest[i]);
      const auto above = value_at(up);
      if (!above) return hal::fail(above.error());
      const auto below = value_at(down);
      if (!below) return hal::fail(below.error());
      for (std::size_t f = 0; f < above->size(); ++f)
        out[i].push_back(((*above)[f] - (*below)[f]) / (up[i] - down[i]));
    }
    return out;
  }

  // From afar: Levenberg's steps, as long as one makes the squares a tenth smaller.
  hal::Result<Point> approach(Point at, std::vector<double> here) {
    for (int step = 0; step < kMostSteps && evaluations_ + 5 < options_.evaluations; ++step) {
      const auto tilt = slopes(at, &here);
      if (!tilt) return hal::fail(tilt.error());
      double damping = 0.01;
      double share = 1.0;
      for (int attempt = 0; attempt < 3; ++attempt, damping *= 10.0) {
        const auto next = levenberg(at, here, *tilt, damping);
        if (!next) break;
        auto there = differences(*next);
        if (!there) return hal::fail(std::move(there).error());
        share = squares_of(*there) / std::max(squares_of(here), 1e-9);
        if (share >= 1.0) continue;
        at = *next;
        here = std::move(*there);
        break;
      }
      if (share > 0.9) break;
    }
    return at;
  }

  hal::Result<Point> search(const Point& from) {
    std::optional<hal::Error> trouble;
    const auto squares = [&](const std::vector<double>& x) {
      if (trouble) return kHopeless;
      const auto differences_now = differences({x[0], x[1], x[2]});
      if (!differences_now) {
        trouble = differences_now.error();
        return kHopeless;
      }
      double sum = squares_of(*differences_now);
      for (std::size_t i = 0; i < kParameters; ++i)
        sum += 1e3 * std::max({0.0, kLowest[i] - x[i], x[i] - kHighest[i]});
      return sum;
    };
    const auto found =
        simplex_search(squares, {from.begin(), from.end()}, {std::begin(kStep), std::end(kStep)},
                       {std::max(options_.evaluations - evaluations_, 4), 0.5});
    if (trouble) return hal::fail(std::move(*trouble));
    Point best{};
    for (std::size_t i = 0; i < kParameters; ++i) best[i] = std::clamp(found.at[i], kLowest[i], kHighest[i]);
    return best;
  }

  [[nodiscard]] const Reproduction& last() const { return last_; }
  [[nodiscard]] int evaluations() const { return evaluations_; }
  [[nodiscard]] const std::vector<std::string>& runs() const { return reproduce_.runs; }

 private:
  PublishedFitOptions options_;
  ReproduceOptions reproduce_;
  Reproduction last_;
  int evaluations_ = 0;
};

// Half widths of the 95 % intervals.
hal::Result<Point> half_widths(Fit& fit, const Point& best, const std::vector<double>& residuals) {
  if (residuals.size() <= kParameters)
    return hal::fail(hal::ErrorCode::refused, "published totals", "tell r0_m, spread_db, rician_k_db",
                     fmt::format("{} figures do not tell {} parameters", residuals.size(), kParameters),
                     "Fit to more runs.");
  const auto tilt = fit.slopes(best, nullptr);
  if (!tilt) return hal::fail(tilt.error());
  const auto& slopes = *tilt;
  Matrix information{};
  const double squares = squares_of(residuals);
  for (std::size_t i = 0; i < kParameters; ++i)
    for (std::size_t j = 0; j < kParameters; ++j)
      for (std::size_t f = 0; f < residuals.size(); ++f)
        information[i][j] += slopes[i][f] * slopes[j][f] * kStep[i] * kStep[j];
  for (std::size_t i = 0; i < kParameters; ++i)
    if (!(information[i][i] > 1e-6))
      return hal::fail(hal::ErrorCode::refused, "published totals", fmt::format("tell {}", kNames[i]),
                       "no figure depends on it", "Fit to other runs.");
  const auto covariance = inverse(information);
  if (!covariance)
    return hal::fail(hal::ErrorCode::refused, "published totals", "tell r0_m, spread_db, rician_k_db",
                     "the figures depend on them together only: the information matrix is singular",
                     "Fit to more runs.");
  const auto freedom = static_cast<double>(residuals.size() - kParameters);
  Point widths{};
  for (std::size_t i = 0; i < kParameters; ++i)
    widths[i] = student_975(freedom) * kStep[i] * std::sqrt((*covariance)[i][i] * squares / freedom);
  return widths;
}

}  // namespace

hal::Result<PublishedFit> fit_published(const PublishedFitOptions& options) {
  Fit fit(options);
  const auto scene = load_scene(fmt::format("{}/{}.toml", options.folder, fit.runs().front()));
  if (!scene) return hal::fail(scene.error());
  const SceneRadio& radio = scene->world.radio;
  PublishedFit result;
  result.started = options.start.value_or(
      CalibrationParameters{radio.r0_m, radio.spread_db, std::min(radio.rician_k_db, kHighest[2])});
  Point from{std::log(result.started.r0_m), result.started.spread_db, result.started.rician_k_db};
  for (std::size_t i = 0; i < kParameters; ++i) from[i] = std::clamp(from[i], kLowest[i], kHighest[i]);
  const auto started = fit.differences(from);
  if (!started) return hal::fail(started.error());
  result.started_rms_points = fit.last().rms_points().value_or(0.0);
  const bool searching = options.evaluations > 1;
  const auto near = searching && options.start ? fit.approach(from, *started) : hal::Result<Point>(from);
  if (!near) return hal::fail(near.error());
  const auto best = searching ? fit.search(*near) : near;
  if (!best) return hal::fail(best.error());
  const auto residuals = fit.differences(*best);
  if (!residuals) return hal::fail(residuals.error());
  result.reproduction = fit.last();
  const auto widths = half_widths(fit, *best, *residuals);
  if (!widths) return hal::fail(widths.error());
  for (std::size_t i = 0; i < kParameters; ++i) {
    FittedParameter p;
    p.name = kNames[i];
    p.unit = kUnits[i];
    p.value = (*best)[i];
    p.low = std::max(p.value - (*widths)[i], kLowest[i]);
    p.high = std::min(p.value + (*widths)[i], kHighest[i]);
    p.open_low = p.low == kLowest[i] && kLowest[i] != 0.0;
    p.open_high = p.high == kHighest[i];
    if (i == 0) {
      p.value = std::exp(p.value);
      p.low = std::exp(p.low);
      p.high = std::exp(p.high);
    }
    result.parameters.push_back(std::move(p));
  }
  result.evaluations = fit.evaluations();
  return result;
}

}  // namespace forager::boards
