#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::hal {

// Pinhole camera looking along body +x, image columns growing to the right (-y), rows downwards (-z). Depth
// is the distance along the optical axis, not along the ray (REP-118, RealSense convention).
struct DepthCameraModel {
  int columns = 0;
  int rows = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;  // optical axis; pixel centres are at integer + 0.5
  double cy_px = 0.0;
  double min_m = 0.15;  // outside min..max the sensor reports "unknown"
  double max_m = 7.0;
};

// Row-major image, as the camera delivers it: metres (0, NaN, inf = unknown) or millimetres (0 and 65535 =
// unknown). The pixels stay valid until the next poll() of the source they came from.
struct DepthFrame {
  Instant stamp;  // time of exposure
  DepthCameraModel camera;
  std::variant<std::span<const std::uint16_t>, std::span<const float>> pixels;
};

class DepthSource {
 public:
  virtual ~DepthSource() = default;
  // The newest frame since the last call, or nullopt. Errors: disconnected, io.
  [[nodiscard]] Result<std::optional<DepthFrame>> poll(Instant now) { return do_poll(now); }

 private:
  virtual Result<std::optional<DepthFrame>> do_poll(Instant now) = 0;
};

}  // namespace forager::hal
