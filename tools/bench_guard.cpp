#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "flight/obstacle_guard.hpp"
#include "hal/random.hpp"
#include "tools/bench_duel.hpp"

namespace forager::tools {
namespace {

constexpr hal::Instant kNow{std::chrono::seconds(1)};

hal::DepthCameraModel camera(int columns, int rows) {
  const double scale = columns / 640.0;
  return {columns, rows, 343.0 * scale, 442.0 * scale, columns / 2.0, rows / 2.0, 0.15, 7.0};
}

// An aisle in millimetres: shelves at +-1.75 m, floor 1.8 m below, a wall at 6 m, 3 % of the pixels unknown.
std::vector<std::uint16_t> aisle(const hal::DepthCameraModel& model) {
  hal::Random random(7);
  std::vector<std::uint16_t> image;
  for (int row = 0; row < model.rows; ++row)
    for (int column = 0; column < model.columns; ++column) {
      const double side = std::abs(column + 0.5 - model.cx_px) / model.fx_px;
      const double down = (row + 0.5 - model.cy_px) / model.fy_px;
      const double noise = 0.01 * random.normal();
      const double depth = std::min({6.0, 1.75 / side, down > 0.0 ? 1.8 / down : 7.0}) + noise;
      image.push_back(random.chance(0.03) ? std::uint16_t{0} : static_cast<std::uint16_t>(depth * 1000.0));
    }
  return image;
}

struct Contest {
  explicit Contest(int columns, int rows)
      : model(camera(columns, rows)), image(aisle(model)), minima(static_cast<std::size_t>(columns)) {}

  hal::DepthCameraModel model;
  std::vector<std::uint16_t> image;
  std::vector<std::uint16_t> minima;
  flight::ObstacleGuard guard{flight::GuardConfig{}};
  flight::GuardVerdict verdict;

  void ours() {
    verdict = guard.check({kNow, model, std::span<const std::uint16_t>(image)}, 0.5, 0.0, kNow);
    keep(verdict);
  }
  // The printed rule: the smallest depth of every column, each column from top to bottom. It knows nothing of
  // a corridor, so the floor and the shelves stop it; what it costs is one look at every pixel.
  void other() {
    const auto columns = static_cast<std::size_t>(model.columns);
    const auto rows = static_cast<std::size_t>(model.rows);
    for (std::size_t column = 0; column < columns; ++column) {
      std::uint16_t least = 0xFFFF;
      for (std::size_t row = 0; row < rows; ++row) {
        const std::uint16_t depth = image[row * columns + column];
        if (depth != 0 && depth < least) least = depth;
      }
      minima[column] = least;
    }
    keep(minima.data());
  }
  // They answer different questions about one picture: the way ahead is clear up to the wall, and the nearest
  // thing in it is a shelf or the floor beside it.
  bool agree() {
    ours();
    other();
    const double nearest_m = *std::min_element(minima.begin(), minima.end()) * 1e-3;
    return verdict.way == flight::WayAhead::clear && nearest_m > 1.0 && nearest_m <= verdict.range_m;
  }
};

}  // namespace

Duel guard_duel(int columns, int rows) {
  const auto contest = std::make_shared<Contest>(columns, rows);
  return {.name = fmt::format("obstacle guard {}x{}", columns, rows),
          .unit = "images/s",
          .peer = "column minima, top to bottom",
          .items = 1.0,
          .ours = [contest] { contest->ours(); },
          .other = [contest] { contest->other(); },
          .agree = [contest] { return contest->agree(); }};
}

}  // namespace forager::tools
