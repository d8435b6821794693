#include "mocks/tag_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace forager::mocks {
namespace {

constexpr double kFarthest_m = 1e12;
constexpr double kCellsPerPoint = 4.0;
constexpr double kMostCellsAnyway = 4096.0;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

double square(double x) { return x * x; }

tl::unexpected<hal::Error> refuse(std::string detail) {
  return hal::fail(hal::ErrorCode::invalid_argument, "tag grid", "build", std::move(detail));
}

hal::Result<> check(const PointSpans& points, double cell_m) {
  if (points.x.size() != points.y.size() || points.x.size() != points.z.size())
    return refuse(
        fmt::format("{} x, {} y and {} z coordinates", points.x.size(), points.y.size(), points.z.size()));
  if (points.x.size() >= std::numeric_limits<std::uint32_t>::max())
    return refuse(fmt::format("{} points are too many", points.x.size()));
  if (!(cell_m > 0.0 && cell_m <= kFarthest_m)) return refuse(fmt::format("cells of {} m", cell_m));
  return {};
}

hal::Result<> check_point(const PointSpans& points, std::size_t id) {
  if (id >= points.x.size()) return refuse(fmt::format("there is no point {}", id));
  const auto usable = [](double v) { return std::abs(v) <= kFarthest_m; };  // false for NaN
  if (usable(points.x[id]) && usable(points.y[id]) && usable(points.z[id])) return {};
  return refuse(fmt::format("point {} at ({}, {}, {}) is not within {} m", id, points.x[id], points.y[id],
                            points.z[id], kFarthest_m));
}

}  // namespace

hal::Result<TagGrid> TagGrid::build(const PointSpans& points, double cell_m) {
  FORAGER_TRY(check(points, cell_m));
  std::vector<std::uint32_t> all(points.x.size());
  std::iota(all.begin(), all.end(), 0U);
  return build(points, all, cell_m);
}

hal::Result<TagGrid> TagGrid::build(const PointSpans& points, std::span<const std::uint32_t> ids,
                                    double cell_m) {
  FORAGER_TRY(check(points, cell_m));
  TagGrid grid;
  if (ids.empty()) return grid;
  FORAGER_TRY(check_point(points, ids.front()));
  grid.low_ = grid.high_ = {points.x[ids.front()], points.y[ids.front()], points.z[ids.front()]};
  for (const std::uint32_t id : ids) {
    FORAGER_TRY(check_point(points, id));
    const hal::Vec3 p{points.x[id], points.y[id], points.z[id]};
    grid.low_ = {std::min(grid.low_.x, p.x), std::min(grid.low_.y, p.y), std::min(grid.low_.z, p.z)};
    grid.high_ = {std::max(grid.high_.x, p.x), std::max(grid.high_.y, p.y), std::max(grid.high_.z, p.z)};
  }
  grid.lay_out(points, ids, cell_m);
  return grid;
}

void TagGrid::lay_out(const PointSpans& points, std::span<const std::uint32_t> ids, double cell_m) {
  const double width = high_.x - low_.x;
  const double depth = high_.y - low_.y;
  const double most = std::max(kMostCellsAnyway, kCellsPerPoint * static_cast<double>(ids.size()));
  cell_m_ = cell_m;
  while ((std::floor(width / cell_m_) + 1.0) * (std::floor(depth / cell_m_) + 1.0) > most) cell_m_ *= 1.25;
  per_cell_ = 1.0 / cell_m_;
  const double farthest = std::max({std::abs(low_.x), std::abs(low_.y), std::abs(low_.z), std::abs(high_.x),
                                    std::abs(high_.y), std::abs(high_.z), cell_m_});
  slack_m_ = 16.0 * kEpsilon * farthest;
  columns_ = static_cast<std::size_t>(width * per_cell_) + 1;
  rows_ = static_cast<std::size_t>(depth * per_cell_) + 1;

  start_.assign(columns_ * rows_ + 1, 0);
  std::vector<std::uint32_t> cell_of(ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::size_t column = index(points.x[ids[i]] - low_.x, columns_);
    const std::size_t row = index(points.y[ids[i]] - low_.y, rows_);
    cell_of[i] = static_cast<std::uint32_t>(row * columns_ + column);
    ++start_[cell_of[i] + 1];
  }
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  x_.resize(ids.size());
  y_.resize(ids.size());
  z_.resize(ids.size());
  id_.resize(ids.size());
  // start_ of a cell walks to its end here, and is put back below.
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::uint32_t slot = start_[cell_of[i]]++;
    x_[slot] = points.x[ids[i]];
    y_[slot] = points.y[ids[i]];
    z_[slot] = points.z[ids[i]];
    id_[slot] = ids[i];
  }
  std::copy_backward(start_.begin(), start_.end() - 1, start_.end());
  start_[0] = 0;
}

// Grows with `along_m`, whatever the rounding: points that are ordered along an axis lie in ordered cells.
std::size_t TagGrid::index(double along_m, std::size_t count) const {
  return static_cast<std::size_t>(std::clamp(along_m * per_cell_, 0.0, static_cast<double>(count - 1)));
}

bool TagGrid::rows_of(hal::Vec3 centre, double radius_m, Rows& rows) const {
  if (id_.empty() || !(radius_m >= 0.0) || !is_finite(centre)) return false;
  rows.centre = centre;
  const double slack =
      slack_m_ + 16.0 * kEpsilon * (radius_m + std::abs(centre.x) + std::abs(centre.y) + std::abs(centre.z));
  rows.outer_m = radius_m + slack;
  if (low_.x - centre.x > rows.outer_m || centre.x - high_.x > rows.outer_m ||
      low_.y - centre.y > rows.outer_m || centre.y - high_.y > rows.outer_m ||
      low_.z - centre.z > rows.outer_m || centre.z - high_.z > rows.outer_m)
    return false;
  const double inner = radius_m - slack;
  const double height = std::max(std::abs(low_.z - centre.z), std::abs(high_.z - centre.z));
  rows.inner2_m2 = inner > height ? (inner - height) * (inner + height) : -1.0;
  rows.first = index(centre.y - rows.outer_m - low_.y, rows_);
  rows.last = index(centre.y + rows.outer_m - low_.y, rows_);
  return true;
}

TagGrid::Chord TagGrid::chord_of(const Rows& rows, std::size_t row) const {
  // The row's band, a little wider than its points may lie.
  const double low = low_.y + static_cast<double>(row) * cell_m_ - slack_m_ - rows.centre.y;
  const double high = low + cell_m_ + 2.0 * slack_m_;
  const double nearest = std::max({low, -high, 0.0});
  const double farthest = std::max(-low, high);
  const double outer2 = square(rows.outer_m) - square(nearest);
  // The first and last rows hold whatever clamping moved there, so their nearest may be wrong only outwards.
  if (outer2 < 0.0) return {};
  const double outer = std::sqrt(outer2) + 16.0 * kEpsilon * rows.outer_m;
  const double from = rows.centre.x - low_.x;
  Chord chord;
  chord.first = index(from - outer, columns_);
  chord.last = index(from + outer, columns_);
  const double inner2 = rows.inner2_m2 - square(farthest);
  if (!(inner2 > 0.0)) return chord;
  const double inner = std::sqrt(inner2) - slack_m_ - cell_m_ * 1e-6;
  // The cell after the one the chord begins in, up to the one before that it ends in.
  const double begin = std::floor((from - inner) * per_cell_) + 1.0;
  const double end = std::floor((from + inner) * per_cell_) - 1.0;
  const double first = std::max(begin, static_cast<double>(chord.first));
  const double last = std::min(end, static_cast<double>(chord.last));
  if (first > last) return chord;
  chord.inner_first = static_cast<std::size_t>(first);
  chord.inner_last = static_cast<std::size_t>(last);
  return chord;
}

void TagGrid::within(hal::Vec3 centre, double radius_m, std::vector<std::uint32_t>& out) const {
  const double radius2 = square(radius_m);
  std::size_t most = out.size();
  visit(centre, radius_m, [&](const Run& run) { most += run.last - run.first; });
  std::size_t used = out.size();
  out.resize(most);
  std::uint32_t* const ids = out.data();
  visit(centre, radius_m, [&](const Run& run) {
    if (run.inside) {
      std::copy(id_.begin() + static_cast<std::ptrdiff_t>(run.first),
                id_.begin() + static_cast<std::ptrdiff_t>(run.last), ids + used);
      used += run.last - run.first;
      return;
    }
    // Written always, kept only if within: no branch to mispredict along the rim.
    for (std::size_t slot = run.first; slot < run.last; ++slot) {
      const double d2 =
          square(x_[slot] - centre.x) + square(y_[slot] - centre.y) + square(z_[slot] - centre.z);
      ids[used] = id_[slot];
      used += d2 <= radius2 ? 1U : 0U;
    }
  });
  out.resize(used);
}

}  // namespace forager::mocks
