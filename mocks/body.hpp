#pragma once

#include "hal/pose.hpp"
#include "hal/time.hpp"

namespace forager::mocks {

// The true state of the simulated vehicle: what the world, the camera and the air see. World frame, REP-103.
struct BodyState {
  hal::Pose pose;
  hal::Vec3 velocity_world_m_s;
  double yaw_rate_rad_s = 0.0;
  bool armed = false;
  bool on_ground = true;
};

// Whoever knows where the vehicle really is: the emulated autopilot in process, or a truth feed over a
// socket.
class TrueBody {
 public:
  virtual ~TrueBody() = default;
  [[nodiscard]] virtual const BodyState& state() const = 0;
};

}  // namespace forager::mocks
