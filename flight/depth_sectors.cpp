#include "flight/depth_sectors.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

namespace forager::flight {
namespace {

// Metres, or nothing for an unknown pixel.
std::optional<double> depth_of(std::uint16_t pixel, const hal::DepthCameraModel& camera) {
  if (pixel == 0 || pixel == 65535 || pixel < camera.min_m * 1000.0) return std::nullopt;
  return pixel / 1000.0;
}
std::optional<double> depth_of(float pixel, const hal::DepthCameraModel& camera) {
  if (!std::isfinite(pixel) || pixel < camera.min_m || pixel <= 0.0F) return std::nullopt;
  return pixel;
}

// Points of one sector, of which only the nearest are kept.
class Nearest {
 public:
  explicit Nearest(std::size_t k) : k_(std::max<std::size_t>(k, 1)) {}
  void add(double depth_m) {
    if (kept_.size() == k_ && depth_m >= kept_.back()) return;
    kept_.insert(std::ranges::upper_bound(kept_, depth_m), depth_m);
    if (kept_.size() > k_) kept_.pop_back();
  }
  [[nodiscard]] std::optional<double> kth() const {
    return kept_.size() == k_ ? std::optional(kept_.back()) : std::nullopt;
  }

 private:
  std::size_t k_;
  std::vector<double> kept_;
};

template <class Pixel>
void scan(std::span<const Pixel> pixels, const hal::DepthCameraModel& camera, const GuardConfig& config,
          int first, int last, DepthSector& sector) {
  Nearest nearest(config.nearest);
  const auto columns = static_cast<std::size_t>(camera.columns);
  for (int row = 0; row < camera.rows; ++row) {
    const double up_per_m = -(row + 0.5 - camera.cy_px) / camera.fy_px;
    for (int column = first; column < last; ++column) {
      ++sector.pixels;
      const std::size_t at = static_cast<std::size_t>(row) * columns + static_cast<std::size_t>(column);
      const auto depth_m = depth_of(pixels[at], camera);
      if (!depth_m) continue;
      ++sector.valid;
      const double up_m = *depth_m * up_per_m;
      if (*depth_m < camera.max_m && up_m <= config.above_m && up_m >= -config.below_m) nearest.add(*depth_m);
    }
  }
  sector.nearest_m = nearest.kth();
}

double bearing_of(double column, const hal::DepthCameraModel& camera) {
  return std::atan2(camera.cx_px - column, camera.fx_px);
}

}  // namespace

std::vector<DepthSector> depth_sectors(const hal::DepthFrame& frame, const GuardConfig& config, int sectors) {
  const hal::DepthCameraModel& camera = frame.camera;
  const auto wanted = static_cast<std::size_t>(std::max(camera.columns, 0)) *
                      static_cast<std::size_t>(std::max(camera.rows, 0));
  std::vector<DepthSector> out;
  std::visit(
      [&](const auto& pixels) {
        if (pixels.size() != wanted || wanted == 0) return;
        for (int i = 0; i < std::min(sectors, camera.columns); ++i) {
          const int count = std::min(sectors, camera.columns);
          const int first = camera.columns * i / count;
          const int last = camera.columns * (i + 1) / count;
          DepthSector& sector = out.emplace_back();
          sector.left_rad = bearing_of(first, camera);
          sector.right_rad = bearing_of(last, camera);
          scan(pixels, camera, config, first, last, sector);
        }
      },
      frame.pixels);
  return out;
}

}  // namespace forager::flight
