#pragma once

#include <cstdint>
#include <optional>

#include "hal/error.hpp"
#include "hal/pose.hpp"
#include "hal/time.hpp"

namespace forager::hal {

enum class PoseConfidence : std::uint8_t { failed, low, medium, high };  // T265 tracker confidence 0..3

struct PoseSample {
  Instant stamp;
  Pose pose;  // body in the world frame, after the camera's mounting was taken out
  PoseConfidence confidence = PoseConfidence::high;
  std::uint8_t reset_counter = 0;  // grows when the source itself relocalised
};

// A localisation source (VSLAM camera, motion capture, a double).
class PoseSource {
 public:
  virtual ~PoseSource() = default;
  // The newest sample since the last call, or nullopt. Errors: disconnected, io.
  [[nodiscard]] Result<std::optional<PoseSample>> poll(Instant now) { return do_poll(now); }

 private:
  virtual Result<std::optional<PoseSample>> do_poll(Instant now) = 0;
};

}  // namespace forager::hal
