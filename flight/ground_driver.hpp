#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hal/error.hpp"
#include "hal/halt.hpp"
#include "hal/pose.hpp"
#include "hal/time.hpp"

namespace forager::flight {

enum class GroundState : std::uint8_t {
  parked,   // both brakes locked, no thrust, motors disarmed
  driving,  // it has the vehicle
  arrived,  // parked at the end of its way
  blocked,  // parked: something in the way did not go away
  failed,   // parked, and not to be asked again: a person looks first
};
[[nodiscard]] std::string_view to_string(GroundState state);

struct GroundStatus {
  GroundState state = GroundState::parked;
  std::string detail;  // of the end
};

// Drives a vehicle on its wheels along a line; what a hybrid mission needs of it. Safe state: parked, at
// construction and after halt(). While it drives it commands autopilot and brakes and reads the localisation;
// in every other state it holds the brakes and leaves the other two alone.
class GroundDriver : public hal::Halt {
 public:
  // Corners of the way in the world frame; the first is where the vehicle is. Errors: invalid_state (it
  // drives already, or has failed), invalid_argument (fewer than two corners, not finite, no length).
  [[nodiscard]] hal::Result<> begin(const std::vector<hal::Vec3>& way_world, hal::Instant now) {
    return do_begin(way_world, now);
  }
  // At 50 Hz or faster, in every state: it holds the brakes.
  void update(hal::Instant now) { do_update(now); }
  [[nodiscard]] const GroundStatus& status() const { return do_status(); }

 private:
  virtual hal::Result<> do_begin(const std::vector<hal::Vec3>& way_world, hal::Instant now) = 0;
  virtual void do_update(hal::Instant now) = 0;
  [[nodiscard]] virtual const GroundStatus& do_status() const = 0;
};

}  // namespace forager::flight
