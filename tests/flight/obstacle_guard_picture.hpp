#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "flight/obstacle_guard.hpp"
#include "hal/depth_source.hpp"
#include "hal/pose.hpp"
#include "hal/units.hpp"

namespace forager::flight::test {

using namespace std::chrono_literals;
inline constexpr hal::Instant kNow{100s};
inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInf = std::numeric_limits<float>::infinity();

inline hal::DepthCameraModel camera(int columns = 160, int rows = 120) {
  hal::DepthCameraModel model;
  model.columns = columns;
  model.rows = rows;
  model.fx_px = columns / (2.0 * std::tan(hal::deg_to_rad(86.0) / 2.0));
  model.fy_px = rows / (2.0 * std::tan(hal::deg_to_rad(57.0) / 2.0));
  model.cx_px = columns / 2.0;
  model.cy_px = rows / 2.0;
  return model;
}

// What a level or pitched camera sees of axis-aligned boxes given in its level frame (x forward, y left, z
// up).
struct Block {
  hal::Vec3 min, max;
};
struct Picture {
  hal::DepthCameraModel model = camera();
  std::vector<float> metres = {};

  void fill(float value) { metres.assign(static_cast<std::size_t>(model.columns * model.rows), value); }
  void render(const std::vector<Block>& blocks, double pitch_rad = 0.0) {
    fill(static_cast<float>(model.max_m));
    const double c = std::cos(pitch_rad);
    const double s = std::sin(pitch_rad);
    for (int row = 0; row < model.rows; ++row)
      for (int column = 0; column < model.columns; ++column) {
        const double up = -(row + 0.5 - model.cy_px) / model.fy_px;
        const hal::Vec3 ray{c + s * up, -(column + 0.5 - model.cx_px) / model.fx_px, c * up - s};
        for (const Block& block : blocks) {
          double enter = 0.0;
          double leave = model.max_m;
          for (const auto axis : {&hal::Vec3::x, &hal::Vec3::y, &hal::Vec3::z}) {
            const double a = block.min.*axis / ray.*axis;
            const double b = block.max.*axis / ray.*axis;
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
          }
          float& pixel = metres[static_cast<std::size_t>(row * model.columns + column)];
          if (enter <= leave) pixel = std::min(pixel, static_cast<float>(enter));
        }
      }
  }
  [[nodiscard]] hal::DepthFrame frame(hal::Instant stamp = kNow) const {
    return {stamp, model, std::span<const float>(metres)};
  }
  [[nodiscard]] std::vector<std::uint16_t> millimetres() const {
    std::vector<std::uint16_t> out(metres.size());
    std::transform(metres.begin(), metres.end(), out.begin(), [](float m) {
      return m > 0.0F && m < 65.0F ? static_cast<std::uint16_t>(std::lround(m * 1000.0F)) : std::uint16_t{0};
    });
    return out;
  }
};

inline GuardConfig walls_config() {
  GuardConfig config;  // a 1.2 m body
  config.half_width_m = 0.6;
  config.clear_distance_m = 2.0;
  return config;
}

}  // namespace forager::flight::test
