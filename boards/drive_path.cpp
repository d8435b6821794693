#include "boards/drive_path.hpp"

#include <algorithm>
#include <cmath>

namespace forager::boards {
namespace {

DrivePoint between(DrivePoint a, DrivePoint b, double share) {
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
}

double gap(DrivePoint a, DrivePoint b) { return std::hypot(b.x - a.x, b.y - a.y); }

// The same way as a fine polyline.
std::vector<DrivePoint> outline(std::span<const DrivePoint> corners, double corner_m) {
  constexpr int kPieces = 32;
  std::vector<DrivePoint> line{corners.front()};
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const double before = gap(corners[i - 1], corners[i]);
    const double after = gap(corners[i], corners[i + 1]);
    const double cut = std::min({corner_m, 0.5 * before, 0.5 * after});
    if (!(cut > 0.0)) continue;
    const DrivePoint from = between(corners[i], corners[i - 1], cut / before);
    const DrivePoint to = between(corners[i], corners[i + 1], cut / after);
    for (int k = 0; k <= kPieces; ++k) {
      const double t = static_cast<double>(k) / kPieces;
      line.push_back(between(between(from, corners[i], t), between(corners[i], to, t), t));
    }
  }
  line.push_back(corners.back());
  return line;
}

}  // namespace

std::vector<servo::PathPose> rounded_path(std::span<const DrivePoint> corners, double corner_m,
                                          double spacing_m) {
  const std::vector<DrivePoint> line = outline(corners, corner_m);
  std::vector<servo::PathPose> path;
  double left = 0.0;  // way from the present piece's start to the next pose
  double yaw = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double length = gap(line[i], line[i + 1]);
    if (!(length > 0.0)) continue;
    yaw = std::atan2(line[i + 1].y - line[i].y, line[i + 1].x - line[i].x);
    while (left < length) {
      const DrivePoint at = between(line[i], line[i + 1], left / length);
      path.push_back({at.x, at.y, yaw});
      left += spacing_m;
    }
    left -= length;
  }
  path.push_back({line.back().x, line.back().y, yaw});
  return path;
}

}  // namespace forager::boards
