#pragma once

#include <memory>

#include "boards/drive_run.hpp"
#include "boards/drive_scene.hpp"
#include "flight/drive_loop.hpp"
#include "hal/error.hpp"
#include "mocks/rolling_vehicle.hpp"

namespace forager::boards {

// An emulated vehicle with everything the drive loop borrows, whatever lies between.
class DriveRig {
 public:
  virtual ~DriveRig() = default;
  [[nodiscard]] virtual flight::DriveDevices devices(hal::Journal& journal) = 0;
  [[nodiscard]] virtual mocks::RollingVehicle& vehicle() = 0;
  // Where it truly is, rolling or flying.
  [[nodiscard]] virtual const mocks::BodyState& body() { return vehicle().state(); }
  // Emulated devices and vehicle live up to `now`.
  virtual void advance(hal::Instant now) = 0;
  // A fault of the devices or the vehicle; those of the program are the runner's.
  virtual void strike(DriveFault fault, hal::Instant now) = 0;
  // Nothing asks the autopilot for a push any more.
  [[nodiscard]] virtual bool push_demanded() const = 0;
};

[[nodiscard]] hal::Result<std::unique_ptr<DriveRig>> make_direct_rig(const DriveScene& scene,
                                                                     std::uint64_t seed);
// The same vehicle behind MAVLink bytes and servo pulses. It takes off when it is told to, and stands on its
// wheels again once it has landed and is disarmed.
[[nodiscard]] hal::Result<std::unique_ptr<DriveRig>> make_wire_rig(const DriveScene& scene,
                                                                   std::uint64_t seed, hal::Journal& journal);

// What a fault does to the vehicle itself, the same in both rigs.
void strike_vehicle(mocks::RollingVehicle& vehicle, DriveFault fault);

}  // namespace forager::boards
