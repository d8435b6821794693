#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/error.hpp"
#include "hal/pose.hpp"

namespace forager::mocks {

// Coordinates of many points, each axis by itself (structure of arrays); spans of equal length, metres.
struct PointSpans {
  std::span<const double> x;
  std::span<const double> y;
  std::span<const double> z;
};

// Uniform grid over the ground plan of many fixed points. Points lie in memory cell by cell, row by row
// (counting sort), so that a row of cells is one run of memory and cells wholly within reach are copied
// unseen. Building is linear in points and cells; cells are widened where a sparse world would need more than
// four per point. Which points a query finds does not depend on the cells. Copies of coordinates: 28 bytes a
// point and up to 16 for the cells.
class TagGrid {
 public:
  // Slots first .. last-1; `inside`: each of them is certainly within the radius asked for.
  struct Run {
    std::size_t first = 0;
    std::size_t last = 0;
    bool inside = false;
  };

  TagGrid() = default;  // no points

  // Ids are places in the spans. Errors: invalid_argument (a coordinate that is NaN, infinite or beyond 1e12
  // m, naming the point; cell_m not above 0; more than 2^32 - 2 points).
  [[nodiscard]] static hal::Result<TagGrid> build(const PointSpans& points, double cell_m = 1.0);
  // Of some of the points only: those with these ids.
  [[nodiscard]] static hal::Result<TagGrid> build(const PointSpans& points,
                                                  std::span<const std::uint32_t> ids, double cell_m = 1.0);

  [[nodiscard]] std::size_t size() const { return id_.size(); }
  [[nodiscard]] double cell_m() const { return cell_m_; }

  // Appends the ids of all points with |point - centre| <= radius_m (squares compared, in double), in the
  // order of the grid. A radius below 0 or NaN and a centre that is not finite find nothing; an infinite
  // radius finds all.
  void within(hal::Vec3 centre, double radius_m, std::vector<std::uint32_t>& out) const;

  // Calls visit(Run) for runs of slots that together hold every point within the radius, and others near it.
  template <class Visit>
  void visit(hal::Vec3 centre, double radius_m, Visit&& visit) const {
    Rows rows;
    if (!rows_of(centre, radius_m, rows)) return;
    for (std::size_t row = rows.first; row <= rows.last; ++row) {
      const Chord chord = chord_of(rows, row);
      if (chord.first > chord.last) continue;
      const std::uint32_t* const start = start_.data() + row * columns_;
      const auto run = [&](std::size_t from, std::size_t to, bool inside) {
        if (start[from] < start[to]) visit(Run{start[from], start[to], inside});
      };
      if (chord.inner_first > chord.inner_last) {
        run(chord.first, chord.last + 1, false);
      } else {
        run(chord.first, chord.inner_first, false);
        run(chord.inner_first, chord.inner_last + 1, true);
        run(chord.inner_last + 1, chord.last + 1, false);
      }
    }
  }

  // By slot.
  [[nodiscard]] std::span<const double> x() const { return x_; }
  [[nodiscard]] std::span<const double> y() const { return y_; }
  [[nodiscard]] std::span<const double> z() const { return z_; }
  [[nodiscard]] std::span<const std::uint32_t> id() const { return id_; }

 private:
  struct Rows {
    hal::Vec3 centre;
    double outer_m = 0.0;    // radius, and what rounding may add
    double inner2_m2 = 0.0;  // square of the radius less the height and rounding: negative, nothing is inside
    std::size_t first = 0;
    std::size_t last = 0;
  };
  struct Chord {  // columns of one row; inner: cells wholly within
    std::size_t first = 1;
    std::size_t last = 0;
    std::size_t inner_first = 1;
    std::size_t inner_last = 0;
  };

  void lay_out(const PointSpans& points, std::span<const std::uint32_t> ids, double cell_m);
  [[nodiscard]] bool rows_of(hal::Vec3 centre, double radius_m, Rows& rows) const;
  [[nodiscard]] Chord chord_of(const Rows& rows, std::size_t row) const;
  [[nodiscard]] std::size_t index(double along_m, std::size_t count) const;

  hal::Vec3 low_;
  hal::Vec3 high_;
  double cell_m_ = 1.0;
  double per_cell_ = 1.0;
  double slack_m_ = 0.0;  // rounding of coordinates and cells
  std::size_t columns_ = 0;
  std::size_t rows_ = 0;
  std::vector<std::uint32_t> start_;  // first slot of each cell, and the end of the last
  std::vector<double> x_;
  std::vector<double> y_;
  std::vector<double> z_;
  std::vector<std::uint32_t> id_;
};

}  // namespace forager::mocks
