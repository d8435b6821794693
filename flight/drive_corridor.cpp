#include "flight/drive_corridor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace forager::flight {

hal::Result<DriveCorridor> DriveCorridor::create(std::vector<hal::Vec3> path, double half_width_m) {
  const auto refuse = [](const char* why, const char* mend) {
    return hal::fail(hal::ErrorCode::invalid_argument, "corridor", "create", why, mend);
  };
  if (path.empty()) return refuse("its path has no point", "Give the path the vehicle is to follow.");
  if (!std::ranges::all_of(path, [](const hal::Vec3& p) { return hal::is_finite(p); }))
    return refuse("a point of its path is not finite", "Check the planner.");
  if (!(half_width_m > 0.0) || !std::isfinite(half_width_m))
    return refuse("its half width is not positive", "Give metres to each side of the path.");
  return DriveCorridor(std::move(path), half_width_m);
}

double DriveCorridor::distance_m(hal::Vec3 at) const {
  if (!std::isfinite(at.x) || !std::isfinite(at.y)) return std::numeric_limits<double>::quiet_NaN();
  double best = std::numeric_limits<double>::infinity();
  hal::Vec3 a = path_.front();
  for (const hal::Vec3& b : path_) {
    const double dx = b.x - a.x;
    const double dy = b.y - a.y;
    const double square = dx * dx + dy * dy;
    const double along =
        square > 0.0 ? std::clamp(((at.x - a.x) * dx + (at.y - a.y) * dy) / square, 0.0, 1.0) : 0.0;
    const double off_x = at.x - a.x - along * dx;
    const double off_y = at.y - a.y - along * dy;
    best = std::min(best, off_x * off_x + off_y * off_y);
    a = b;
  }
  return std::sqrt(best);
}

}  // namespace forager::flight
