#include "boards/published_turn.hpp"

#include <cmath>
#include <limits>

#include "hal/units.hpp"

namespace forager::boards {

PublishedTurn published_turn(servo::Target target, Reading reading) {
  constexpr double kR = 0.5;
  PublishedTurn out{.left = target.y_m >= 0.0, .drive_m = std::hypot(target.x_m, target.y_m)};  // 6.10
  if (target.y_m == 0.0) return out;
  const double x = target.x_m;
  const double y = std::abs(target.y_m) - kR;
  // 6.7, with c as printed: r^4 - r^2 y where r^4 - r^2 y^2 was meant.
  const double a = y * y + x * x;
  const double b = -0.5 * x;
  const double c = reading == Reading::mended ? 0.0625 - 0.25 * y * y : 0.0625 - 0.25 * y;
  const double root = std::sqrt(b * b - 4.0 * a * c);
  double nearest = std::numeric_limits<double>::infinity();
  out.turn_rad = std::numeric_limits<double>::quiet_NaN();
  for (const double sign : {1.0, -1.0}) {
    const double x_turned = (-b + sign * root) / (2.0 * a);          // 6.8
    const double beside = std::sqrt(kR * kR - x_turned * x_turned);  // 6.4
    const double across = (kR * kR - x_turned * x) / y;              // 6.5
    const bool mended = reading == Reading::mended;
    for (const double y_turned : {mended ? across : beside, mended ? across : -beside}) {
      const double away = std::hypot(x_turned, y_turned + kR);
      if (!(away < nearest)) continue;
      nearest = away;
      if (mended) out.drive_m = std::hypot(x - x_turned, y - y_turned);
      const double turn = std::atan2(x_turned, -y_turned);  // from S_i = (0, -r) about O
      out.turn_rad = turn < 0.0 ? turn + 2.0 * hal::kPi : turn;
    }
  }
  return out;
}

}  // namespace forager::boards
