#include "boards/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "boards/reproduce.hpp"
#include "boards/simplex_search.hpp"

namespace forager::boards {
namespace {

// 95 % of chi-square with one degree of freedom.
constexpr double kChiSquare95 = 3.841458820694124;
constexpr std::size_t kParameters = 3;
constexpr double kLowest[kParameters] = {-3.0, 0.0, -10.0};  // ln(R0/m), dB, dB
constexpr double kHighest[kParameters] = {3.5, 12.0, 30.0};
constexpr double kStep[kParameters] = {0.15, 0.7, 3.0};
constexpr const char* kNames[kParameters] = {"r0_m", "spread_db", "rician_k_db"};
constexpr const char* kUnits[kParameters] = {"m", "dB", "dB"};
constexpr std::uint64_t kFewestReads = 100;
constexpr std::size_t kFewestTags = 10;
// Ranges must differ by this factor between the 5 and 95 % points of what was heard.
constexpr double kRangeFactor = 1.2;

using Point = std::array<double, kParameters>;

CalibrationParameters parameters_at(const Point& p) { return {std::exp(p[0]), p[1], p[2]}; }
Point point_of(const CalibrationParameters& p) { return {std::log(p.r0_m), p.spread_db, p.rician_k_db}; }

// Maximises over the parameters that are not held.
class Fitter {
 public:
  explicit Fitter(const CalibrationLikelihood& likelihood) : likelihood_(&likelihood) {}

  struct Best {
    Point at{};
    double log_likelihood = -std::numeric_limits<double>::infinity();
  };

  Best fit(const Point& from, const std::array<bool, kParameters>& held, int evaluations) {
    std::vector<std::size_t> free;
    std::vector<double> start;
    std::vector<double> step;
    for (std::size_t i = 0; i < kParameters; ++i) {
      if (held[i]) continue;
      free.push_back(i);
      start.push_back(from[i]);
      step.push_back(from[i] + steps_[i] > kHighest[i] ? -steps_[i] : steps_[i]);
    }
    Point at = from;
    const auto loss = [&](const std::vector<double>& x) {
      double outside = 0.0;
      for (std::size_t i = 0; i < free.size(); ++i) {
        at[free[i]] = std::clamp(x[i], kLowest[free[i]], kHighest[free[i]]);
        outside += std::abs(x[i] - at[free[i]]);
      }
      return -likelihood_->log_likelihood(parameters_at(at)) + 10.0 * outside;
    };
    const SimplexResult found = simplex_search(loss, start, step, {evaluations, 5e-3});
    evaluations_ += found.evaluations;
    Best best;
    best.log_likelihood = -loss(found.at);
    best.at = at;
    return best;
  }

  [[nodiscard]] double value(Point at) {
    for (std::size_t i = 0; i < kParameters; ++i) at[i] = std::clamp(at[i], kLowest[i], kHighest[i]);
    ++evaluations_;
    return likelihood_->log_likelihood(parameters_at(at));
  }
  [[nodiscard]] int evaluations() const { return evaluations_; }
  [[nodiscard]] std::vector<double> tag_values(Point at) {
    for (std::size_t i = 0; i < kParameters; ++i) at[i] = std::clamp(at[i], kLowest[i], kHighest[i]);
    ++evaluations_;
    return likelihood_->log_likelihoods(parameters_at(at));
  }
  // What the first simplex spans from now on.
  void set_steps(const Point& steps) { steps_ = steps; }

 private:
  const CalibrationLikelihood* likelihood_;
  Point steps_{kStep[0], kStep[1], kStep[2]};
  int evaluations_ = 0;
};

// Best of two starts, so that a shallow side valley does not catch it.
Fitter::Best fit_all(Fitter& fitter, const CalibrationCells& cells, const std::array<bool, kParameters>& held,
                     const Point& given) {
  Fitter::Best best;
  for (const double spread : {1.0, 4.0}) {
    Point from{std::log(std::max(0.6 * cells.farthest_m, 0.1)), spread, spread < 2.0 ? 5.0 : 15.0};
    for (std::size_t i = 0; i < kParameters; ++i)
      if (held[i]) from[i] = given[i];
    const Fitter::Best found = fitter.fit(from, held, 50);
    if (found.log_likelihood > best.log_likelihood) best = found;
  }
  return best;
}

// The likelihood about the best fit: how far each parameter may go alone until it loses one standard
// deviation, and how the likelihood bends, in these units.
struct Bend {
  Point unit{};
  std::array<Point, kParameters> matrix{};
};

Bend bend_at(Fitter& fitter, const Fitter::Best& best) {
  Bend bend;
  std::array<double, kParameters> up_value{};
  const auto shifted = [&](std::size_t i, double by) {
    Point at = best.at;
    at[i] += by;
    return at;
  };
  for (std::size_t i = 0; i < kParameters; ++i) {
    const double h = 0.1 * kStep[i];
    const double second =
        (2.0 * best.log_likelihood - fitter.value(shifted(i, h)) - fitter.value(shifted(i, -h))) / (h * h);
    bend.unit[i] =
        std::clamp(second > 0.0 ? 1.0 / std::sqrt(second) : kStep[i], 0.01 * kStep[i], 2.0 * kStep[i]);
    up_value[i] = fitter.value(shifted(i, bend.unit[i]));
    bend.matrix[i][i] = 1.0;
  }
  for (std::size_t i = 0; i < kParameters; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      Point both = shifted(i, bend.unit[i]);
      both[j] += bend.unit[j];
      const double mixed = up_value[i] + up_value[j] - best.log_likelihood - fitter.value(both);
      bend.matrix[i][j] = bend.matrix[j][i] = std::clamp(mixed, -0.98, 0.98);
    }
  return bend;
}

// Where the other two parameters are best while one is `away` units from its place, by the bend.
Point along_ridge(const Fitter::Best& best, const Bend& bend, std::size_t which, double away) {
  const std::size_t a = (which + 1) % kParameters;
  const std::size_t b = (which + 2) % kParameters;
  const double det = 1.0 - bend.matrix[a][b] * bend.matrix[a][b];
  const double ga = -bend.matrix[a][which] * away;
  const double gb = -bend.matrix[b][which] * away;
  Point at = best.at;
  at[which] += away * bend.unit[which];
  at[a] += bend.unit[a] * (ga - bend.matrix[a][b] * gb) / det;
  at[b] += bend.unit[b] * (gb - bend.matrix[a][b] * ga) / det;
  return at;
}

// The matrix of a bend, turned round; not meant for nearly singular ones, which the clamp on its elements
// keeps away for two parameters and the determinant's floor for three.
std::array<Point, kParameters> inverse_of(const std::array<Point, kParameters>& m) {
  std::array<Point, kParameters> out{};
  double det = 0.0;
  for (std::size_t j = 0; j < 3; ++j)
    det += m[0][j] * (m[1][(j + 1) % 3] * m[2][(j + 2) % 3] - m[1][(j + 2) % 3] * m[2][(j + 1) % 3]);
  det = std::max(det, 0.01);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      out[j][i] = (m[(i + 1) % 3][(j + 1) % 3] * m[(i + 2) % 3][(j + 2) % 3] -
                   m[(i + 1) % 3][(j + 2) % 3] * m[(i + 2) % 3][(j + 1) % 3]) /
                  det;
  return out;
}

// How many times wider than the likelihood says an estimate really scatters, as a variance (Godambe's
// sandwich, tags as the independent units): places that share part of a fade count as independent in the
// likelihood, but the scores of the tags show how much they are not. At least 1.
Point excess_variance(Fitter& fitter, const Fitter::Best& best, const Bend& bend) {
  std::array<std::vector<double>, kParameters> scores;  // per unit of the bend
  for (std::size_t i = 0; i < kParameters; ++i) {
    Point up = best.at;
    Point down = best.at;
    up[i] += 0.3 * bend.unit[i];
    down[i] -= 0.3 * bend.unit[i];
    const auto above = fitter.tag_values(up);
    const auto below = fitter.tag_values(down);
    for (std::size_t tag = 0; tag < above.size(); ++tag) scores[i].push_back((above[tag] - below[tag]) / 0.6);
  }
  const auto inverse = inverse_of(bend.matrix);
  Point excess{};
  for (std::size_t i = 0; i < kParameters; ++i) {
    double variance = 0.0;
    for (std::size_t tag = 0; tag < scores[0].size(); ++tag) {
      double shift = 0.0;
      for (std::size_t j = 0; j < kParameters; ++j) shift += inverse[i][j] * scores[j][tag];
      variance += shift * shift;
    }
    excess[i] = std::clamp(variance / std::max(inverse[i][i], 1e-6), 1.0, 25.0);
  }
  return excess;
}

// What the profile likelihood loses, twice, where one parameter is held at a value.
double profile_loss(Fitter& fitter, const Fitter::Best& best, const Bend& bend,
                    std::array<bool, kParameters> held, std::size_t which, double value) {
  Point from = along_ridge(best, bend, which, (value - best.at[which]) / bend.unit[which]);
  for (std::size_t i = 0; i < kParameters; ++i) {
    if (held[i]) from[i] = best.at[i];
    from[i] = std::clamp(from[i], kLowest[i], kHighest[i]);
  }
  from[which] = value;
  held[which] = true;
  return 2.0 * (best.log_likelihood - fitter.fit(from, held, 25).log_likelihood);
}

// Where the profile likelihood has lost enough, on one side of the best fit. The root of the loss is about
// linear in the parameter, so the secant is quick; at the limit of what is looked at the interval stays open.
double interval_end(Fitter& fitter, const Fitter::Best& best, const Bend& bend,
                    const std::array<bool, kParameters>& held, std::size_t which, double direction,
                    double excess, bool& open) {
  const double limit = direction < 0.0 ? kLowest[which] : kHighest[which];
  const double room = std::abs(limit - best.at[which]);
  const double wanted = std::sqrt(kChiSquare95 * excess);
  double away = 2.5 * bend.unit[which];
  double before = 0.0;
  double loss_before = 0.0;
  for (int i = 0; i < 6; ++i) {
    const bool at_limit = away >= room;
    away = std::min(away, room);
    const double loss = std::sqrt(
        std::max(0.0, profile_loss(fitter, best, bend, held, which, best.at[which] + direction * away)));
    if (at_limit && loss < wanted) {
      open = true;
      return limit;
    }
    // Through the last two points; through the best fit while they say nothing.
    const double slope = loss > loss_before && away > before ? (loss - loss_before) / (away - before) : 0.0;
    const double next = slope > 0.0 ? away + (wanted - loss) / slope : 2.0 * away;
    const bool near = std::abs(loss - wanted) < 0.15 * wanted;
    if (loss < wanted) {
      before = away;
      loss_before = loss;
    }
    away = std::clamp(next, 0.2 * away, 4.0 * away);
    if (near) break;
  }
  return best.at[which] + direction * std::min(away, room);
}

// Fits once more in steps that suit the likelihood's width, and says how it bends there.
Bend polish(Fitter& fitter, Fitter::Best& best, const std::array<bool, kParameters>& held) {
  fitter.set_steps(bend_at(fitter, best).unit);
  best = fitter.fit(best.at, held, 70);
  const Bend bend = bend_at(fitter, best);
  Point half{};
  for (std::size_t i = 0; i < kParameters; ++i) half[i] = 0.5 * bend.unit[i];
  fitter.set_steps(half);
  return bend;
}

hal::Failure refuse(std::string which, std::string why, std::string mend) {
  return hal::fail(hal::ErrorCode::refused, "recording", fmt::format("tell {}", which), std::move(why),
                   std::move(mend));
}

hal::Result<> check_recording(const Recording& recording, const CalibrationCells& cells,
                              const CalibrationOptions& options) {
  if (recording.poses.size() < 2)
    return refuse("r0_m", "there are fewer than two poses", "Record poses along with the reads.");
  std::size_t tags = 0;
  for (std::size_t tag = 0; tag + 1 < cells.tag_begin.size(); ++tag)
    if (cells.tag_begin[tag] != cells.tag_begin[tag + 1]) ++tags;
  if (cells.reads < kFewestReads)
    return refuse("r0_m, spread_db, rician_k_db",
                  fmt::format("only {} reads of known tags while poses are known", cells.reads),
                  fmt::format("It takes {} at least.", kFewestReads));
  if (tags < kFewestTags)
    return refuse("spread_db", fmt::format("only {} tags came before an antenna", tags),
                  fmt::format("It takes {} at least.", kFewestTags));
  if (cells.farthest_m < kRangeFactor * cells.nearest_m)
    return refuse("r0_m",
                  fmt::format("all tags were heard at about one range, {:.2f} to {:.2f} m on boresight",
                              cells.nearest_m, cells.farthest_m),
                  "Record tags at ranges that differ by half or more.");
  if (cells.seen_slices > 0.99 * cells.slices)
    return refuse("r0_m", "every tag was heard all the time: R0 has no upper bound",
                  "Record from farther away, or with less power.");
  if (!options.rician_k_db && cells.moved_m < 2.0 * options.slicing.fade_length_m)
    return refuse(
        "rician_k_db",
        fmt::format("the vehicle moved by {:.2f} m only: each tag showed one fade, which looks like its "
                    "sensitivity",
                    cells.moved_m),
        "Record a moving vehicle, or hold rician_k_db at a value.");
  return {};
}

std::vector<CalibrationResidual> residuals_of(const CalibrationCells& cells,
                                              const CalibrationLikelihood& likelihood,
                                              const CalibrationParameters& p) {
  constexpr std::size_t kSpans = 10;
  const std::vector<double> expected = likelihood.expected_seen(p);
  std::vector<double> ranges;
  for (const CalibrationBin& bin : cells.bins) ranges.push_back(bin.range_m);
  std::vector<CalibrationResidual> out;
  for (std::size_t span = 0; span < kSpans; ++span) {
    CalibrationResidual r;
    r.from_m = span == 0 ? 0.0 : out.back().to_m;
    r.to_m = quantile(ranges, static_cast<double>(span + 1) / kSpans);
    double variance = 0.0;
    for (std::size_t b = 0; b < cells.bins.size(); ++b) {
      const CalibrationBin& bin = cells.bins[b];
      if (bin.range_m <= r.from_m || bin.range_m > r.to_m) continue;
      const double slices = bin.seen + bin.unseen;
      r.slices += slices;
      r.seen += bin.seen;
      r.expected += expected[b];
      variance += expected[b] * (1.0 - std::min(expected[b] / slices, 1.0));
    }
    r.standardised = variance > 0.0 ? (r.seen - r.expected) / std::sqrt(variance) : 0.0;
    out.push_back(r);
  }
  return out;
}

}  // namespace

hal::Result<Calibration> calibrate(const Recording& recording, const Scene& scene,
                                   const CalibrationOptions& options) {
  const CalibrationCells cells = cells_of(recording, scene, options.slicing);
  FORAGER_TRY(check_recording(recording, cells, options));
  const CalibrationLikelihood likelihood(cells, scene.world.radio.t0_s, scene.world.radio.power_up_limit);
  Fitter fitter(likelihood);
  const std::array<bool, kParameters> held{false, options.spread_db.has_value(),
                                           options.rician_k_db.has_value()};
  const Point given{0.0, options.spread_db.value_or(0.0), options.rician_k_db.value_or(0.0)};
  Fitter::Best best = fit_all(fitter, cells, held, given);
  const Bend bend = polish(fitter, best, held);
  const Point excess = excess_variance(fitter, best, bend);
  Calibration result;
  for (std::size_t i = 0; i < kParameters; ++i) {
    FittedParameter p;
    p.name = kNames[i];
    p.unit = kUnits[i];
    p.value = p.low = p.high = best.at[i];
    p.held = held[i];
    if (!held[i]) {
      p.low = interval_end(fitter, best, bend, held, i, -1.0, excess[i], p.open_low);
      p.high = interval_end(fitter, best, bend, held, i, 1.0, excess[i], p.open_high);
      if (p.open_low && p.open_high)
        return refuse(p.name, "the likelihood does not depend on it: its information is singular",
                      "Record more, from more places.");
    }
    if (i == 0) {
      if (p.open_low || p.open_high)
        return refuse(p.name, p.open_high ? "it has no upper bound" : "it has no lower bound",
                      "Record ranges at which some tags answer and some do not.");
      p.value = std::exp(p.value);
      p.low = std::exp(p.low);
      p.high = std::exp(p.high);
    }
    result.parameters.push_back(std::move(p));
  }
  result.residuals = residuals_of(cells, likelihood, parameters_at(best.at));
  result.log_likelihood = best.log_likelihood;
  result.evaluations = fitter.evaluations();
  result.tags = recording.tags.size();
  result.reads = cells.reads;
  result.strangers = recording.strangers;
  return result;
}

hal::Result<std::array<double, 3>> profile_losses(const Recording& recording, const Scene& scene,
                                                  const CalibrationParameters& truth) {
  const CalibrationCells cells = cells_of(recording, scene);
  FORAGER_TRY(check_recording(recording, cells, {}));
  const CalibrationLikelihood likelihood(cells, scene.world.radio.t0_s, scene.world.radio.power_up_limit);
  Fitter fitter(likelihood);
  Fitter::Best best = fit_all(fitter, cells, {}, {});
  const Bend bend = polish(fitter, best, {});
  const Point excess = excess_variance(fitter, best, bend);
  std::array<double, 3> losses{};
  for (std::size_t i = 0; i < kParameters; ++i)
    losses[i] = profile_loss(fitter, best, bend, {}, i, point_of(truth)[i]) / excess[i];
  return losses;
}

}  // namespace forager::boards
