// The obstacle guard on a 640 x 480 image of an aisle, against two peers in the same process: the same rule
// written pixel by pixel in double precision, and the printed rule (minimum of the column minima), which
// needs no geometry at all and so bounds from below what a pass over the image costs.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "flight/obstacle_guard.hpp"
#include "hal/random.hpp"

namespace forager::flight {
namespace {

constexpr int kColumns = 640;
constexpr int kRows = 480;
constexpr hal::Instant kNow{std::chrono::seconds(1)};

hal::DepthCameraModel camera() { return {kColumns, kRows, 343.0, 442.0, 320.0, 240.0, 0.15, 7.0}; }

// Shelves at +-1.75 m, floor 1.8 m below, end wall at 6 m, 3 % of the pixels unknown.
std::vector<float> aisle_m() {
  const hal::DepthCameraModel model = camera();
  hal::Random random(7);
  std::vector<float> image;
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const double side = std::abs(column + 0.5 - model.cx_px) / model.fx_px;
      const double down = (row + 0.5 - model.cy_px) / model.fy_px;
      const double depth =
          std::min({6.0, 1.75 / side, down > 0.0 ? 1.8 / down : 7.0}) + 0.01 * random.normal();
      image.push_back(random.chance(0.03) ? 0.0F : static_cast<float>(depth));
    }
  return image;
}

std::vector<std::uint16_t> aisle_mm() {
  std::vector<std::uint16_t> image;
  for (const float m : aisle_m()) image.push_back(static_cast<std::uint16_t>(m * 1000.0F));
  return image;
}

void guard_millimetres(benchmark::State& state) {
  const auto image = aisle_mm();
  ObstacleGuard guard(GuardConfig{});
  const hal::DepthFrame frame{kNow, camera(), std::span<const std::uint16_t>(image)};
  for (auto _ : state) benchmark::DoNotOptimize(guard.check(frame, 0.5, 0.0, kNow));
}
BENCHMARK(guard_millimetres);

void guard_millimetres_pitching(benchmark::State& state) {
  const auto image = aisle_mm();
  ObstacleGuard guard(GuardConfig{});
  const hal::DepthFrame frame{kNow, camera(), std::span<const std::uint16_t>(image)};
  double pitch_rad = 0.0;
  for (auto _ : state) {
    pitch_rad = pitch_rad > 0.1 ? 0.0 : pitch_rad + 1e-4;
    benchmark::DoNotOptimize(guard.check(frame, 0.5, pitch_rad, kNow));
  }
}
BENCHMARK(guard_millimetres_pitching);

void guard_metres(benchmark::State& state) {
  const auto image = aisle_m();
  ObstacleGuard guard(GuardConfig{});
  const hal::DepthFrame frame{kNow, camera(), std::span<const float>(image)};
  for (auto _ : state) benchmark::DoNotOptimize(guard.check(frame, 0.5, 0.0, kNow));
}
BENCHMARK(guard_metres);

void peer_pixel_by_pixel(benchmark::State& state) {
  const auto image = aisle_mm();
  const hal::DepthCameraModel model = camera();
  const GuardConfig config;
  std::vector<double> inside;
  for (auto _ : state) {
    inside.clear();
    std::uint32_t valid = 0;
    for (int row = 0; row < kRows; ++row)
      for (int column = 0; column < kColumns; ++column) {
        const double depth = image[static_cast<std::size_t>(row * kColumns + column)] * 1e-3;
        if (depth < model.min_m || depth > 65.534) continue;
        const double y = -depth * (column + 0.5 - model.cx_px) / model.fx_px;
        const double z = -depth * (row + 0.5 - model.cy_px) / model.fy_px;
        ++valid;
        if (std::abs(y) <= config.half_width_m + config.side_margin_m && z <= config.above_m &&
            z >= -config.below_m)
          inside.push_back(depth);
      }
    std::nth_element(inside.begin(), inside.begin() + 4, inside.end());
    benchmark::DoNotOptimize(inside[4]);
    benchmark::DoNotOptimize(valid);
  }
}
BENCHMARK(peer_pixel_by_pixel);

void peer_column_minima(benchmark::State& state) {
  const auto image = aisle_mm();
  std::vector<std::uint16_t> minima(kColumns);
  for (auto _ : state) {
    std::fill(minima.begin(), minima.end(), std::uint16_t{65535});
    for (std::size_t row = 0; row < kRows; ++row)
      for (std::size_t column = 0; column < kColumns; ++column) {
        const std::uint16_t depth = image[row * kColumns + column];
        const std::uint16_t known = depth == 0 ? std::uint16_t{65535} : depth;
        minima[column] = known < minima[column] ? known : minima[column];
      }
    benchmark::DoNotOptimize(*std::min_element(minima.begin(), minima.end()));
  }
}
BENCHMARK(peer_column_minima);

}  // namespace
}  // namespace forager::flight

BENCHMARK_MAIN();
