#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "hal/depth_source.hpp"
#include "hal/time.hpp"

namespace forager::flight {

enum class WayAhead : std::uint8_t {
  clear,    // enough of the corridor is seen, and nothing stands in it nearer than required
  blocked,  // something does
  blind,    // too little of the corridor is seen, or what is seen is too old: treated as blocked
};
[[nodiscard]] std::string_view to_string(WayAhead way);  // "clear", "blocked", "blind"

struct GuardConfig {
  // The corridor the body sweeps flying straight ahead, around the optical axis.
  double half_width_m = 0.6;   // of the body, tips included
  double side_margin_m = 0.2;  // added at each side
  double above_m = 0.4;        // upper edge above the camera
  double below_m = 0.5;        // lower edge below the camera; must stay short of the floor

  // d = max(clear_distance, v^2 / (2 braking) + v * latency + margin), measured from the camera.
  double clear_distance_m = 2.0;
  double braking_m_s2 = 1.5;
  double latency_s = 0.4;  // exposure to the vehicle slowing down
  double margin_m = 0.5;

  double valid_share = 0.5;   // of the pixels that look through the corridor; less is blind
  std::uint32_t nearest = 5;  // k: the k-th smallest range decides, so k - 1 wild pixels do not
  hal::Duration max_age = std::chrono::milliseconds(300);  // an older frame is blind
  bool operator==(const GuardConfig&) const = default;
};

struct GuardVerdict {
  WayAhead way = WayAhead::blind;
  double range_m = 0.0;  // k-th nearest point in the corridor; the sensor's reach if there are fewer; 0 blind
  double required_m = 0.0;          // d it was held against
  std::uint32_t window_pixels = 0;  // pixels whose ray is still inside the corridor at distance d
  std::uint32_t valid_pixels = 0;   // those of them that measured something
  hal::Instant stamp;               // exposure of the frame
  std::string_view reason;          // why not clear: "obstacle", "few valid pixels", "old frame", ...
};

// Passive obstacle avoidance on a depth image (system specification section 4). Every pixel is a point
// depth * (1, -(u - cx)/fx, -(v - cy)/fy); it counts if it lies in the corridor, so that the floor and the
// shelves at both sides of an aisle do not block it. For one pixel that is the same as depth <= limit(column)
// and depth <= limit(row), both known before the frame arrives: two small tables, one pass.
//
// What is unknown: 0, 65535, NaN, infinities, negative values, anything nearer than the sensor's minimum. A
// value at or beyond the sensor's maximum is a measurement: free as far as the sensor reaches. So an image of
// nothing but 7 m (maximum 7 m) is clear, and an image of nothing but 0 is blind even in an open hall: a
// camera that answers 0 for "too far" cannot be told from one that is covered. A back end that knows better
// fills in its maximum, as the emulated camera does.
//
// Ranges are depths along the optical axis. Pitch is taken out of the height band; roll is not (at 5 degrees
// and 0.5 m it moves a point by 4 cm, inside the side margin).
class ObstacleGuard {
 public:
  explicit ObstacleGuard(const GuardConfig& config) : config_(config) {}

  // d for a forward speed; backward speeds count as standing still, NaN as needing endless room.
  [[nodiscard]] double required_distance_m(double forward_speed_m_s) const;

  // Judges a frame. pitch_rad: attitude at exposure, positive nose down. Allocates only when the camera model
  // changes. A frame whose pixels do not match its model is blind.
  GuardVerdict check(const hal::DepthFrame& frame, double forward_speed_m_s, double pitch_rad,
                     hal::Instant now);

  // The last verdict as it stands now: blind once its frame is too old, or if there never was one.
  [[nodiscard]] GuardVerdict latest(hal::Instant now) const;

  [[nodiscard]] const GuardConfig& config() const { return config_; }

 private:
  struct Scan {
    std::uint32_t valid = 0;
    std::size_t found = 0;
    double kth_m = 0.0;
  };
  void prepare(const hal::DepthCameraModel& camera, double pitch_rad);
  template <class Pixel>
  [[nodiscard]] Scan scan(std::span<const Pixel> pixels, double required_m);
  GuardVerdict judge(const hal::DepthFrame& frame, double required_m, hal::Instant now, double pitch_rad);

  GuardConfig config_;
  GuardVerdict last_;
  hal::DepthCameraModel camera_;
  double pitch_rad_ = 0.0;
  bool prepared_ = false;
  // Depth at which the ray of a column (row) leaves the corridor, in metres and in millimetres.
  std::vector<float> column_limit_m_, row_limit_m_;
  std::vector<std::uint16_t> column_limit_mm_, row_limit_mm_;
};

}  // namespace forager::flight
