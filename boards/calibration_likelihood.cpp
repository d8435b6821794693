#include "boards/calibration_likelihood.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mocks/detection.hpp"

namespace forager::boards {
namespace {

struct Node {
  double x;
  double weight;
};
// Gauss-Hermite for the standard normal.
constexpr std::array<Node, 5> kNormal5{{{-2.8569700138728056, 0.0112574113277207},
                                        {-1.355626179974266, 0.222075922005613},
                                        {0.0, 0.533333333333333},
                                        {1.355626179974266, 0.222075922005613},
                                        {2.8569700138728056, 0.0112574113277207}}};
// Across the direct path, where the sign does not matter.
constexpr std::array<Node, 2> kNormalAbs{
    {{0.7419637843027259, 0.908248290463863}, {2.334414218338977, 0.0917517095361369}}};

// A tag heard in many places tells its sensitivity to within half a decibel, for the power-up limit is sharp:
// evenly spaced nodes nearer to each other than that, out to three deviations, where the emulated ones end.
// Fewer of them make large spreads look unlikely, because tags fall between the nodes.
constexpr double kTagStep_db = 0.4;
constexpr std::size_t kFewestTagNodes = 7;
std::vector<Node> tag_nodes(double spread_db) {
  const auto wanted = static_cast<std::size_t>(std::ceil(6.0 * spread_db / kTagStep_db)) + 1;
  std::vector<Node> nodes(std::max(wanted, kFewestTagNodes));
  double sum = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i].x = -3.0 + 6.0 * static_cast<double>(i) / static_cast<double>(nodes.size() - 1);
    nodes[i].weight = std::exp(-0.5 * nodes[i].x * nodes[i].x);
    sum += nodes[i].weight;
  }
  for (Node& node : nodes) node.weight /= sum;
  return nodes;
}

constexpr double kLowest_db = -60.0;
constexpr double kHighest_db = 40.0;
constexpr double kPerDb = 20.0;
constexpr double kLowestReach_db = -40.0;
constexpr double kReachStep_db = 0.25;
constexpr std::size_t kReaches = 321;
constexpr std::size_t kFades = 10;
// The limit is sharp for one tag and one fade; between the few nodes that stand for all of them it is drawn
// over a width of this, or the likelihood would jump.
constexpr double kLimitWidth_db = 0.5;
// What answers without reason (a reflection, a tag that was moved): keeps one read from ruling out
// everything.
constexpr double kStray_per_s = 1e-5;
// A cell that tells less than this is passed over; the strays of ten seconds.
constexpr double kNothing = 1e-4;

struct Fade {
  double db;
  double weight;
};

std::array<Fade, kFades> fades_of(double rician_k_db) {
  const double k = std::pow(10.0, 0.1 * rician_k_db);
  const double direct = std::sqrt(k / (k + 1.0));
  const double part = std::sqrt(0.5 / (k + 1.0));
  std::array<Fade, kFades> fades{};
  std::size_t i = 0;
  for (const Node& along : kNormal5)
    for (const Node& across : kNormalAbs) {
      const double amplitude = std::hypot(direct + part * along.x, part * across.x);
      fades[i++] = {20.0 * std::log10(std::max(amplitude, 1e-3)), along.weight * across.weight};
    }
  return fades;
}

// ln of the weighted mean of what these are the logarithms of.
template <class Logs, class Weight>
double log_mean(const Logs& logs, Weight&& weight) {
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (std::size_t i = 0; i < logs.size(); ++i)
    if (logs[i] > most - 40.0) sum += weight(i) * std::exp(logs[i] - most);
  return most + std::log(sum);
}

}  // namespace

CalibrationLikelihood::CalibrationLikelihood(const CalibrationCells& cells, double t0_s,
                                             double power_up_limit)
    : cells_(&cells) {
  const double limit_db = 20.0 * std::log10(power_up_limit);
  const auto points = static_cast<std::size_t>((kHighest_db - kLowest_db) * kPerDb) + 2;
  rates_.reserve(points);
  for (std::size_t i = 0; i < points; ++i) {
    const double u_db = kLowest_db + static_cast<double>(i) / kPerDb;
    const double powered = 0.5 * std::erfc((u_db - limit_db) / (kLimitWidth_db * std::sqrt(2.0)));
    rates_.push_back(powered * mocks::expected_answers(std::pow(10.0, u_db / 20.0)) / t0_s + kStray_per_s);
  }
  range_db_.reserve(cells.bins.size());
  for (const CalibrationBin& bin : cells.bins)
    range_db_.push_back(20.0 * std::log10(std::max(bin.range_m, 1e-3)));
  tabulate();
}

double CalibrationLikelihood::rate(double u_db) const {
  const double place = std::clamp((u_db - kLowest_db) * kPerDb, 0.0, static_cast<double>(rates_.size() - 2));
  const auto i = static_cast<std::size_t>(place);
  return rates_[i] + (place - static_cast<double>(i)) * (rates_[i + 1] - rates_[i]);
}

void CalibrationLikelihood::tabulate() {
  const std::size_t cells = cells_->cell_begin.size() - 1;
  tables_.resize(cells * kReaches);
  silent_.assign(cells, true);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    for (std::size_t b = cells_->cell_begin[cell]; b < cells_->cell_begin[cell + 1]; ++b)
      if (cells_->bins[b].seen > 0) silent_[cell] = false;
    for (std::size_t i = 0; i < kReaches; ++i) {
      const double reach_db = kLowestReach_db + static_cast<double>(i) * kReachStep_db;
      double log = 0.0;
      for (std::size_t b = cells_->cell_begin[cell]; b < cells_->cell_begin[cell + 1]; ++b) {
        const CalibrationBin& bin = cells_->bins[b];
        const double lambda = rate(range_db_[b] - reach_db);
        log -= lambda * bin.unseen_listen_s;
        if (bin.seen > 0)
          log += bin.seen * std::log(-std::expm1(-lambda * std::max(bin.seen_listen_s, 1e-6)));
      }
      tables_[cell * kReaches + i] = static_cast<float>(log);
    }
  }
}

double CalibrationLikelihood::cell_log(std::size_t cell, double reach_db) const {
  // Cubic through four points: straight lines would bend the likelihood at every step of the table.
  const double place = std::clamp((reach_db - kLowestReach_db) / kReachStep_db, 1.0, kReaches - 2.001);
  const auto i = static_cast<std::size_t>(place);
  const double s = place - static_cast<double>(i);
  const float* p = &tables_[cell * kReaches + i - 1];
  const double before = -s * (s - 1.0) * (s - 2.0) / 6.0;
  const double here = (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0;
  const double next = -(s + 1.0) * s * (s - 2.0) / 2.0;
  const double after = (s + 1.0) * s * (s - 1.0) / 6.0;
  return before * p[0] + here * p[1] + next * p[2] + after * p[3];
}

double CalibrationLikelihood::log_likelihood(const CalibrationParameters& p) const {
  double sum = 0.0;
  for (const double tag : log_likelihoods(p)) sum += tag;
  return sum;
}

std::vector<double> CalibrationLikelihood::log_likelihoods(const CalibrationParameters& p) const {
  const auto fades = fades_of(p.rician_k_db);
  const double r0_db = 20.0 * std::log10(p.r0_m);
  double strongest_db = 0.0;
  for (const Fade& fade : fades) strongest_db = std::max(strongest_db, fade.db);
  std::array<double, kFades> fade_logs{};
  const std::vector<Node> nodes = tag_nodes(p.spread_db);
  std::vector<double> tag_logs(nodes.size());
  std::vector<double> tags;
  tags.reserve(cells_->tag_begin.size());
  for (std::size_t tag = 0; tag + 1 < cells_->tag_begin.size(); ++tag) {
    if (cells_->tag_begin[tag] == cells_->tag_begin[tag + 1]) continue;
    for (std::size_t q = 0; q < nodes.size(); ++q) {
      const double reach_db = r0_db + p.spread_db * nodes[q].x;
      tag_logs[q] = 0.0;
      for (std::size_t cell = cells_->tag_begin[tag]; cell < cells_->tag_begin[tag + 1]; ++cell) {
        // Silent out of reach: nothing to tell, whatever the fade.
        if (silent_[cell] && cell_log(cell, reach_db + strongest_db) > -kNothing) continue;
        for (std::size_t f = 0; f < kFades; ++f) fade_logs[f] = cell_log(cell, reach_db + fades[f].db);
        tag_logs[q] += log_mean(fade_logs, [&](std::size_t f) { return fades[f].weight; });
      }
    }
    tags.push_back(log_mean(tag_logs, [&](std::size_t q) { return nodes[q].weight; }));
  }
  return tags;
}

std::vector<double> CalibrationLikelihood::expected_seen(const CalibrationParameters& p) const {
  const auto fades = fades_of(p.rician_k_db);
  const double r0_db = 20.0 * std::log10(p.r0_m);
  const std::vector<Node> nodes = tag_nodes(p.spread_db);
  std::vector<double> expected;
  expected.reserve(cells_->bins.size());
  for (std::size_t b = 0; b < cells_->bins.size(); ++b) {
    const CalibrationBin& bin = cells_->bins[b];
    double sum = 0.0;
    for (const Node& node : nodes)
      for (const Fade& fade : fades) {
        const double lambda = rate(range_db_[b] - r0_db - p.spread_db * node.x - fade.db);
        const double seen = bin.seen > 0 ? bin.seen * -std::expm1(-lambda * bin.seen_listen_s) : 0.0;
        sum += node.weight * fade.weight *
               (seen + bin.unseen * -std::expm1(-lambda * bin.unseen_listen_s / std::max(bin.unseen, 1U)));
      }
    expected.push_back(sum);
  }
  return expected;
}

}  // namespace forager::boards
