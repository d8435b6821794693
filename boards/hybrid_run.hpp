#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "boards/drive_run.hpp"
#include "boards/hybrid_scene.hpp"
#include "flight/hybrid_mode.hpp"
#include "hal/journal.hpp"

namespace forager::boards {

struct HybridRunOptions {
  std::uint64_t seed = 1;
  DriveFault fault = DriveFault::none;  // strikes in the air, in the middle of the hop
  bool keep_track = false;
  hal::Journal* journal = nullptr;  // may be null
};

struct HybridTrack {
  double at_s = 0.0;
  hal::Vec3 position;
  double yaw_rad = 0.0;
  bool airborne = false;
};

// One run of a hybrid scene, judged by the truth of the emulated vehicle.
struct HybridResult {
  std::uint64_t seed = 0;
  flight::HybridEnd end = flight::HybridEnd::none;
  std::string detail;
  flight::HybridRoute route;  // as planned at the start
  std::size_t hops = 0;       // landed
  double time_s = 0.0;
  double airborne_s = 0.0;
  double rolled_m = 0.0;
  double flown_m = 0.0;  // horizontally
  double position_error_m = 0.0;
  double highest_m = 0.0;
  // Least horizontal distance between body and obstacles where the wheels were lower than the obstacle's top
  // and half the height margin; negative: contact.
  double side_clearance_m = 0.0;
  // Least height of the wheels above an obstacle that the body was over; infinite if over none.
  double over_clearance_m = 0.0;
  bool braked_in_air = true;  // both brakes pressed whenever the wheels were off the ground
  bool stands = false;        // disarmed, on the ground, still
  bool hung = false;          // the time limit of the scene ended it
  std::vector<HybridTrack> track;

  [[nodiscard]] bool arrived(const HybridScene& scene) const;
};

// Plans the route and runs it through MAVLink bytes and servo pulses until the vehicle stands. Errors: those
// of plan_route and of the devices.
[[nodiscard]] hal::Result<HybridResult> run_hybrid(const HybridScene& scene, const HybridRunOptions& options);

// Lines for people: each stretch with why it rolls or hops, both estimates, and every assumption behind them.
[[nodiscard]] std::vector<std::string> describe_route(const HybridScene& scene,
                                                      const flight::HybridRoute& route);

}  // namespace forager::boards
