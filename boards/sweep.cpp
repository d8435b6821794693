#include "boards/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "boards/detection_truth.hpp"
#include "hal/random.hpp"
#include "mocks/gen2_hazard_table.hpp"

namespace forager::boards {
namespace {

constexpr double kWidth_m = 8.0;
constexpr double kStep_s = Sweep::kDuration_s / (Sweep::kPlaces - 1);

// Trapezoids: the ends count half.
double weight_s(std::size_t place) {
  return place == 0 || place + 1 == Sweep::kPlaces ? kStep_s / 2.0 : kStep_s;
}

// The antenna looks along +y: boresight, left and up in its frame.
hal::Vec3 seen_from(hal::Vec3 antenna, hal::Vec3 tag) {
  return {tag.y - antenna.y, antenna.x - tag.x, tag.z - antenna.z};
}

// -ln tanh(u ln 3 / 2) / T0; the rate of a tag nearer than kNearestU is that of one there.
double exact_hazard(const Wide& u) {
  if (!(u.high < 1e4)) return 0.0;
  const long double wide_u = std::max(static_cast<long double>(u.high) + static_cast<long double>(u.low),
                                      static_cast<long double>(mocks::kNearestU));
  const long double t = wide_u * std::log(3.0L);
  const long double tail = std::exp(-t);
  return static_cast<double>((std::log1p(tail) - std::log(-std::expm1(-t))) /
                             static_cast<long double>(Sweep::kT0_s));
}

}  // namespace

Sweep::Sweep(std::uint64_t seed, std::size_t tags) {
  hal::Random random(seed);
  for (std::size_t i = 0; i < tags; ++i) {
    mocks::Epc96 epc{};
    for (std::size_t byte = 0; byte < 4; ++byte)
      epc[byte + 8] = static_cast<std::uint8_t>(i >> (8 * (3 - byte)));
    const double x = random.uniform(0.0, kSpeed_m_s * kDuration_s);
    const double y = random.uniform(-kWidth_m / 2.0, kWidth_m / 2.0);
    world.tags.add(epc, {x, y, random.uniform(0.2, 2.0)}, true);
  }
  antenna = {.port = 1, .position_body = {}, .bearing_rad = hal::kPi / 2.0, .tilt_rad = 0.0};
  air.r0_m = kR0_m;
  air.t0_s = kT0_s;
  air.power_up_limit = std::numeric_limits<double>::infinity();
  air.spread_db = 0.0;
  air.rician_k_db = 60.0;
  air.singulation_s = 0.0;  // whoever waits for another's reply is not listened to
  air.patience_median_s = 1e4;
  air.max_dwell_s = 1e4;
  air.s2_persistence_min_s = air.s2_persistence_max_s = 1e4;

  const double width = hal::deg_to_rad(70.0);  // the laboratory's antenna, as in AirParameters
  exact_exposure.resize(tags);
  for (std::size_t k = 0; k < kPlaces; ++k) {
    const hal::Vec3 at = place(kStep_s * static_cast<double>(k));
    for (std::size_t i = 0; i < tags; ++i) {
      const hal::Vec3 p = seen_from(at, world.tags.position(i));
      if (p.x > 0.0)
        exact_exposure[i] += weight_s(k) * exact_hazard(exact_normalised_range(p, {width, width, kR0_m}));
    }
  }
}

hal::Vec3 Sweep::place(double t_s) const { return {kSpeed_m_s * t_s, 0.0, kHeight_m}; }

double Sweep::expected_tags(const std::vector<double>& exposure, double listened_share) const {
  return std::accumulate(exposure.begin(), exposure.end(), 0.0, [&](double sum, double hazard) {
    return sum - std::expm1(-listened_share * hazard);
  });
}

SweepByKernel::SweepByKernel(const Sweep& sweep, Way way, double cut, bool grid)
    : sweep_(&sweep),
      way_(way),
      kernel_({sweep.air.pattern, Sweep::kR0_m, mocks::DetectionFormula::paper, cut}),
      radius_m_(kernel_.farthest_r0() * Sweep::kR0_m),
      by_grid_(grid),
      exposure_(sweep.world.tags.size()) {
  const mocks::PointSpans points = sweep.world.tags.points();
  if (grid)
    if (auto built = mocks::TagGrid::build(points)) grid_ = *std::move(built);
  const std::size_t tags = sweep.world.tags.size();
  near_.resize(tags);
  std::iota(near_.begin(), near_.end(), 0U);
  for (auto* axis : {&x_, &y_, &z_, &p_}) axis->resize(tags);
  for (auto* axis : {&x_f32_, &y_f32_, &z_f32_, &p_f32_}) axis->resize(tags);
}

const std::vector<double>& SweepByKernel::exposure() {
  std::fill(exposure_.begin(), exposure_.end(), 0.0);
  for (std::size_t k = 0; k < Sweep::kPlaces; ++k)
    visit(sweep_->place(kStep_s * static_cast<double>(k)), weight_s(k));
  return exposure_;
}

void SweepByKernel::visit(hal::Vec3 place, double weight) {
  if (by_grid_) {
    near_.clear();
    grid_.within(place, radius_m_, near_);
  }
  const std::size_t count = near_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const hal::Vec3 p = seen_from(place, sweep_->world.tags.position(near_[i]));
    x_[i] = p.x;
    y_[i] = p.y;
    z_[i] = p.z;
    if (way_ != Way::f32) continue;
    x_f32_[i] = static_cast<float>(p.x);
    y_f32_[i] = static_cast<float>(p.y);
    z_f32_[i] = static_cast<float>(p.z);
  }
  const auto first = [count](auto& v) { return std::span(v).first(count); };
  if (way_ == Way::f32) {
    kernel_.probabilities(first(x_f32_), first(y_f32_), first(z_f32_), first(p_f32_));
    std::copy_n(p_f32_.begin(), count, p_.begin());
  } else if (way_ == Way::f64) {
    kernel_.probabilities(first(x_), first(y_), first(z_), first(p_));
  } else {
    for (std::size_t i = 0; i < count; ++i) p_[i] = kernel_.reference({x_[i], y_[i], z_[i]});
  }
  // The rate nearer than kNearestU, as in the fields.
  const double nearest = mocks::detection_probability(mocks::kNearestU);
  for (std::size_t i = 0; i < count; ++i)
    if (p_[i] > 0.0) exposure_[near_[i]] -= weight / Sweep::kT0_s * std::log1p(-std::min(p_[i], nearest));
}

}  // namespace forager::boards
