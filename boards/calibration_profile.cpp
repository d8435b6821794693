#include "boards/calibration_profile.hpp"

namespace forager::boards::calibration {

// What scores of tags do not show, because it pulls all of them the same way: neighbouring places share part
// of their fade, so K comes out high. Measured, as the mean squared error over the variance that is claimed,
// on 39 recordings of known K.
constexpr double kFadeExcess = 1.4;

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

static Bend bend_at(Fitter& fitter, const Fitter::Best& best) {
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
static Point along_ridge(const Fitter::Best& best, const Bend& bend, std::size_t which, double away) {
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
static std::array<Point, kParameters> inverse_of(const std::array<Point, kParameters>& m) {
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
  excess[2] *= kFadeExcess;
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

}  // namespace forager::boards::calibration
