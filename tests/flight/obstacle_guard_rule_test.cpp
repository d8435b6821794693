// The fast path against the rule it implements, on random pictures.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "flight/obstacle_guard.hpp"
#include "hal/random.hpp"
#include "tests/flight/obstacle_guard_picture.hpp"

namespace forager::flight {
namespace {

using test::camera;
using test::kInf;
using test::kNaN;
using test::kNow;
using test::Picture;
using test::walls_config;

// The rule written out pixel by pixel, without tables: what the fast path must equal.
GuardVerdict by_definition(const Picture& picture, const GuardConfig& config) {
  std::vector<double> inside;
  std::uint32_t window = 0;
  std::uint32_t valid = 0;
  const double half = config.half_width_m + config.side_margin_m;
  const auto in_corridor = [&](double y, double z) {
    return std::abs(y) <= half && z <= config.above_m && z >= -config.below_m;
  };
  for (int row = 0; row < picture.model.rows; ++row)
    for (int column = 0; column < picture.model.columns; ++column) {
      const double left = -(column + 0.5 - picture.model.cx_px) / picture.model.fx_px;
      const double up = -(row + 0.5 - picture.model.cy_px) / picture.model.fy_px;
      const double depth = picture.metres[static_cast<std::size_t>(row * picture.model.columns + column)];
      const bool known = std::isfinite(depth) && depth >= picture.model.min_m;
      const bool looks_through = in_corridor(config.clear_distance_m * left, config.clear_distance_m * up);
      window += looks_through ? 1U : 0U;
      valid += looks_through && known ? 1U : 0U;
      if (known && in_corridor(depth * left, depth * up)) inside.push_back(depth);
    }
  std::sort(inside.begin(), inside.end());
  GuardVerdict verdict;
  verdict.window_pixels = window;
  verdict.valid_pixels = valid;
  verdict.range_m = inside.size() >= config.nearest
                        ? std::min(inside[config.nearest - 1], picture.model.max_m)
                        : picture.model.max_m;
  verdict.way = verdict.range_m < config.clear_distance_m ? WayAhead::blocked : WayAhead::clear;
  if (verdict.way == WayAhead::clear && valid < config.valid_share * window) verdict.way = WayAhead::blind;
  return verdict;
}

RC_GTEST_PROP(ObstacleGuard, EqualsTheRulePixelByPixel, ()) {
  hal::Random random(*rc::gen::arbitrary<std::uint64_t>());
  Picture picture;
  picture.model = camera(*rc::gen::inRange(1, 70), *rc::gen::inRange(1, 50));
  picture.model.cx_px += random.uniform(-4.0, 4.0);
  picture.model.cy_px += random.uniform(-4.0, 4.0);
  picture.fill(0.0F);
  const double unknown_share = random.uniform();
  const double near = random.uniform(0.1, 6.0);
  for (float& pixel : picture.metres) {
    pixel = static_cast<float>(random.uniform(near, 8.0));
    if (random.chance(unknown_share)) {
      constexpr float kUnknown[] = {0.0F, kNaN, kInf, -1.0F, -kInf, 0.1F};
      pixel = kUnknown[random.below(6)];
    }
  }
  GuardConfig config = walls_config();
  config.nearest = 1 + static_cast<std::uint32_t>(random.below(9));
  ObstacleGuard guard(config);
  const GuardVerdict fast = guard.check(picture.frame(), 0.0, 0.0, kNow);
  const GuardVerdict slow = by_definition(picture, config);
  RC_ASSERT(fast.window_pixels == slow.window_pixels);
  if (slow.window_pixels == 0) {
    RC_ASSERT(fast.way != WayAhead::clear);
    return;
  }
  RC_ASSERT(fast.valid_pixels == slow.valid_pixels);
  RC_ASSERT(fast.way == slow.way);
  if (fast.way != WayAhead::blind) RC_ASSERT(std::abs(fast.range_m - slow.range_m) < 1e-6);
}

}  // namespace
}  // namespace forager::flight
