#include "flight/obstacle_guard.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

namespace forager::flight {
namespace {

constexpr std::uint32_t kMostNearest = 64;
constexpr float kFarthestM = 65.534F;  // beyond every depth camera, and the last millimetre value

bool same_optics(const hal::DepthCameraModel& a, const hal::DepthCameraModel& b) {
  return a.columns == b.columns && a.rows == b.rows && a.fx_px == b.fx_px && a.fy_px == b.fy_px &&
         a.cx_px == b.cx_px && a.cy_px == b.cy_px;
}

bool usable(const hal::DepthCameraModel& camera) {
  return camera.columns > 0 && camera.rows > 0 && camera.fx_px > 0.0 && camera.fy_px > 0.0 &&
         std::isfinite(camera.cx_px) && std::isfinite(camera.cy_px) && camera.min_m >= 0.0 &&
         camera.max_m > camera.min_m;
}

float leaves_at(double lateral_per_metre, double positive_limit_m, double negative_limit_m) {
  double depth_m = kFarthestM;
  if (lateral_per_metre > 0.0) depth_m = positive_limit_m / lateral_per_metre;
  if (lateral_per_metre < 0.0) depth_m = negative_limit_m / -lateral_per_metre;
  return static_cast<float>(std::min(depth_m, double{kFarthestM}));
}

std::uint16_t to_mm(float metres) { return static_cast<std::uint16_t>(metres * 1000.0F); }

struct Interval {
  std::size_t first = 0;
  std::size_t last = 0;  // one past
  [[nodiscard]] std::size_t size() const { return last - first; }
};

// Rays inside the corridor at the required distance are neighbours: the limits fall off to both sides.
Interval reaching(std::span<const float> limits_m, double required_m) {
  const auto reaches = [required_m](float limit) { return double{limit} >= required_m; };
  const auto first = std::find_if(limits_m.begin(), limits_m.end(), reaches);
  const auto last = std::find_if_not(first, limits_m.end(), reaches);
  return {static_cast<std::size_t>(first - limits_m.begin()),
          static_cast<std::size_t>(last - limits_m.begin())};
}

// The k smallest values seen so far, sorted. Ordinary comparisons only: an unknown never gets in, so the
// order in which pixels arrive cannot matter.
template <class Pixel>
class Smallest {
 public:
  explicit Smallest(std::uint32_t k) : k_(std::clamp<std::uint32_t>(k, 1, kMostNearest)) {
    values_.fill(std::numeric_limits<Pixel>::max());
  }
  [[nodiscard]] Pixel worst() const { return values_[k_ - 1]; }
  void insert(Pixel value) {
    std::size_t at = k_ - 1;
    for (; at > 0 && value < values_[at - 1]; --at) values_[at] = values_[at - 1];
    values_[at] = value;
    found_ = std::min<std::size_t>(found_ + 1, k_);
  }
  [[nodiscard]] std::size_t found() const { return found_; }

 private:
  std::array<Pixel, kMostNearest> values_;
  std::size_t k_;
  std::size_t found_ = 0;
};

template <class Pixel>
std::uint32_t count_valid(const Pixel* row, Interval columns, Pixel nearest, Pixel farthest) {
  std::uint32_t valid = 0;
  for (std::size_t c = columns.first; c < columns.last; ++c)
    valid += static_cast<std::uint32_t>(row[c] >= nearest) & static_cast<std::uint32_t>(row[c] <= farthest);
  return valid;
}

template <class Pixel>
Pixel inside_or_none(Pixel depth, Pixel column_limit, Pixel row_limit, Pixel nearest) {
  constexpr Pixel kNone = std::numeric_limits<Pixel>::max();
  const Pixel known = depth >= nearest ? depth : kNone;
  return known <= std::min(column_limit, row_limit) ? known : kNone;
}

// Nearest point of one row inside the corridor. Lanes of independent minima: a single running minimum behind
// two selections is more than compilers turn into vector code (8 times slower).
template <class Pixel>
Pixel row_minimum(const Pixel* row, const Pixel* limit, std::size_t columns, Pixel row_limit, Pixel nearest) {
  constexpr std::size_t kLanes = 64;
  std::array<Pixel, kLanes> lane_minimum;
  lane_minimum.fill(std::numeric_limits<Pixel>::max());
  std::size_t c = 0;
  for (; c + kLanes <= columns; c += kLanes)
    for (std::size_t i = 0; i < kLanes; ++i)
      lane_minimum[i] =
          std::min(lane_minimum[i], inside_or_none(row[c + i], limit[c + i], row_limit, nearest));
  for (; c < columns; ++c)
    lane_minimum[0] = std::min(lane_minimum[0], inside_or_none(row[c], limit[c], row_limit, nearest));
  Pixel minimum = lane_minimum[0];
  for (const Pixel lane : lane_minimum) minimum = std::min(minimum, lane);
  return minimum;
}

}  // namespace

std::string_view to_string(WayAhead way) {
  switch (way) {
    case WayAhead::clear:
      return "clear";
    case WayAhead::blocked:
      return "blocked";
    case WayAhead::blind:
      return "blind";
  }
  return "?";
}

double ObstacleGuard::required_distance_m(double forward_speed_m_s) const {
  if (std::isnan(forward_speed_m_s)) return std::numeric_limits<double>::infinity();
  const double v = std::max(0.0, forward_speed_m_s);
  const double stopping = v * v / (2.0 * config_.braking_m_s2) + v * config_.latency_s + config_.margin_m;
  return std::max(config_.clear_distance_m, stopping);
}

void ObstacleGuard::prepare(const hal::DepthCameraModel& camera, double pitch_rad) {
  if (prepared_ && pitch_rad == pitch_rad_ && same_optics(camera, camera_)) return;
  const auto columns = static_cast<std::size_t>(camera.columns);
  const auto rows = static_cast<std::size_t>(camera.rows);
  if (!prepared_ || !same_optics(camera, camera_)) {
    column_limit_m_.resize(columns);
    column_limit_mm_.resize(columns);
    row_limit_m_.resize(rows);
    row_limit_mm_.resize(rows);
    const double half_m = config_.half_width_m + config_.side_margin_m;
    for (std::size_t c = 0; c < columns; ++c) {
      const double left = -(static_cast<double>(c) + 0.5 - camera.cx_px) / camera.fx_px;
      column_limit_m_[c] = leaves_at(left, half_m, half_m);
      column_limit_mm_[c] = to_mm(column_limit_m_[c]);
    }
  }
  const double cosine = std::cos(pitch_rad);
  const double sine = std::sin(pitch_rad);
  for (std::size_t r = 0; r < rows; ++r) {
    const double up = -(static_cast<double>(r) + 0.5 - camera.cy_px) / camera.fy_px;
    row_limit_m_[r] = leaves_at(cosine * up - sine, config_.above_m, config_.below_m);
    row_limit_mm_[r] = to_mm(row_limit_m_[r]);
  }
  camera_ = camera;
  pitch_rad_ = pitch_rad;
  prepared_ = true;
}

template <class Pixel>
ObstacleGuard::Scan ObstacleGuard::scan(std::span<const Pixel> pixels, double required_m) {
  constexpr bool kMetres = std::is_same_v<Pixel, float>;
  const Pixel* column_limit = nullptr;
  const Pixel* row_limit = nullptr;
  Pixel nearest{};
  Pixel farthest{};
  if constexpr (kMetres) {
    column_limit = column_limit_m_.data();
    row_limit = row_limit_m_.data();
    nearest = std::max(static_cast<float>(camera_.min_m), std::numeric_limits<float>::min());
    farthest = std::numeric_limits<float>::max();
  } else {
    column_limit = column_limit_mm_.data();
    row_limit = row_limit_mm_.data();
    const double min_mm = std::round(std::min(camera_.min_m * 1000.0, 65534.0));
    nearest = std::max<std::uint16_t>(static_cast<std::uint16_t>(min_mm), 1);
    farthest = 65534;
  }
  const Interval columns = reaching(column_limit_m_, required_m);
  const Interval rows = reaching(row_limit_m_, required_m);
  Smallest<Pixel> smallest(config_.nearest);
  Scan result;
  for (std::size_t r = 0; r < row_limit_m_.size(); ++r) {
    const Pixel* row = pixels.data() + r * column_limit_m_.size();
    if (r >= rows.first && r < rows.last) result.valid += count_valid(row, columns, nearest, farthest);
    if (row_minimum(row, column_limit, column_limit_m_.size(), row_limit[r], nearest) >= smallest.worst())
      continue;
    for (std::size_t c = 0; c < column_limit_m_.size(); ++c)
      if (inside_or_none(row[c], column_limit[c], row_limit[r], nearest) < smallest.worst())
        smallest.insert(row[c]);
  }
  result.found = smallest.found();
  result.kth_m =
      kMetres ? static_cast<double>(smallest.worst()) : static_cast<double>(smallest.worst()) * 1e-3;
  return result;
}

GuardVerdict ObstacleGuard::judge(const hal::DepthFrame& frame, double required_m, hal::Instant now,
                                  double pitch_rad) {
  GuardVerdict verdict;
  verdict.stamp = frame.stamp;
  verdict.required_m = required_m;
  const auto blind = [&verdict](std::string_view why) {
    verdict.way = WayAhead::blind;
    verdict.reason = why;
    return verdict;
  };
  if (now - frame.stamp > config_.max_age) return blind("old frame");
  if (frame.stamp - now > config_.max_age) return blind("frame from the future");
  if (!usable(frame.camera) || !std::isfinite(pitch_rad)) return blind("camera model or attitude unusable");
  const std::size_t size =
      static_cast<std::size_t>(frame.camera.columns) * static_cast<std::size_t>(frame.camera.rows);
  if (std::visit([](const auto& pixels) { return pixels.size(); }, frame.pixels) != size)
    return blind("frame does not match its camera model");
  if (!std::isfinite(required_m) || required_m > frame.camera.max_m)
    return blind("faster than the sensor sees");

  prepare(frame.camera, pitch_rad);
  const std::size_t window =
      reaching(column_limit_m_, required_m).size() * reaching(row_limit_m_, required_m).size();
  verdict.window_pixels = static_cast<std::uint32_t>(window);
  const Scan seen = std::visit([&](const auto& pixels) { return scan(pixels, required_m); }, frame.pixels);
  verdict.valid_pixels = seen.valid;
  const bool enough = seen.found >= std::clamp<std::uint32_t>(config_.nearest, 1, kMostNearest);
  const double range_m = enough ? std::min(seen.kth_m, frame.camera.max_m) : frame.camera.max_m;
  // Something near is worth saying even when much of the picture is missing.
  if (range_m < required_m) {
    verdict.way = WayAhead::blocked;
    verdict.range_m = range_m;
    verdict.reason = "obstacle";
    return verdict;
  }
  if (window == 0) return blind("camera does not look along the corridor");
  if (static_cast<double>(seen.valid) < config_.valid_share * static_cast<double>(window))
    return blind("few valid pixels");
  verdict.way = WayAhead::clear;
  verdict.range_m = range_m;
  return verdict;
}

GuardVerdict ObstacleGuard::check(const hal::DepthFrame& frame, double forward_speed_m_s, double pitch_rad,
                                  hal::Instant now) {
  last_ = judge(frame, required_distance_m(forward_speed_m_s), now, pitch_rad);
  return last_;
}

GuardVerdict ObstacleGuard::latest(hal::Instant now) const {
  GuardVerdict verdict = last_;
  if (verdict.reason.empty() && verdict.way == WayAhead::blind) {
    verdict.reason = "no frame yet";
  } else if (now - verdict.stamp > config_.max_age) {
    verdict.way = WayAhead::blind;
    verdict.reason = "old frame";
  }
  if (verdict.way == WayAhead::blind) verdict.range_m = 0.0;
  return verdict;
}

}  // namespace forager::flight
