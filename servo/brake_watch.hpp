#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::servo {

enum class BrakeSide : std::uint8_t { left, right };
[[nodiscard]] std::string_view to_string(BrakeSide side);

enum class BrakeFaultKind : std::uint8_t {
  none,
  output,    // the actuator does not take commands: bus, driver, autopilot
  mismatch,  // it measures itself somewhere else than it was told to be
  slip,      // told to lock, and the wheel turns: stuck open, worn, or more thrust than grip
  drag,      // told to be open, and the wheel stands while the other one turns: stuck locked
};
[[nodiscard]] std::string_view to_string(BrakeFaultKind kind);

struct BrakeFault {
  BrakeFaultKind kind = BrakeFaultKind::none;
  std::string detail;  // for people; empty if none
  hal::Instant since{};
  explicit operator bool() const { return kind != BrakeFaultKind::none; }
};

// How the vehicle moves over ground, measured by localisation. Body frame: x forward, positive yaw turns
// left.
struct VehicleMotion {
  double forward_m_s = 0.0;
  double yaw_rate_rad_s = 0.0;
  hal::Instant at{};
};

struct BrakeWatchConfig {
  double half_track_m = 0.5;                               // centre of the body to a wheel
  hal::Duration settle = std::chrono::milliseconds(400);   // after a command, before it is judged
  hal::Duration confirm = std::chrono::milliseconds(150);  // it must look bad for so long without a break
  hal::Duration motion_max_age = std::chrono::milliseconds(200);  // older motion tells nothing
  double measured_tolerance = 0.15;                               // of the travel
  double slip_m_s = 0.10;                                         // a locked wheel may seem to move this fast
  double standing_m_s = 0.03;                                     // a wheel slower than this stands
  double turning_m_s = 0.15;  // the other wheel turns if it is faster than this
};

// Judges one brake from what it was told and what the vehicle does. A wheel at y = +-r (left: +) of a body
// with forward speed v and yaw rate w moves over ground with v -+ w r; a locked wheel must stand.
class BrakeWatch {
 public:
  BrakeWatch(BrakeSide side, const BrakeWatchConfig& config) : side_(side), config_(config) {}

  // What the actuator was told and measures; call after every move.
  // commanded: 0 open .. 1 locked. Locked counts from 0.95 up, open from 0.05 down.
  void saw(double commanded, std::optional<double> measured, hal::Instant now);
  // Judges by the newest motion, if it is fresh. `other_commanded`: a wheel beside a locked one pivots.
  [[nodiscard]] BrakeFaultKind judge(const std::optional<VehicleMotion>& motion, double other_commanded,
                                     hal::Instant now);
  // Starts anew, as after a settled command.
  void reset(hal::Instant now);
  // What was found, in words; valid after judge() answered a fault.
  [[nodiscard]] std::string detail(BrakeFaultKind kind) const;

 private:
  [[nodiscard]] BrakeFaultKind suspicion(const std::optional<VehicleMotion>& motion, double other_commanded,
                                         hal::Instant now);

  BrakeSide side_;
  BrakeWatchConfig config_;
  double commanded_ = 1.0;
  double settled_on_ = 1.0;  // the command since `changed_`
  std::optional<double> measured_;
  double wheel_m_s_ = 0.0;
  double other_wheel_m_s_ = 0.0;
  hal::Instant changed_{};
  BrakeFaultKind suspected_ = BrakeFaultKind::none;
  hal::Instant suspected_since_{};
};

// First order: held at `fraction` the rise above ambient goes to fraction^2 * hold_rise_k with time constant
// tau. The parameters are estimates for a standard servo stalled against a brake; name better ones per
// vehicle.
struct BrakeHeatConfig {
  double hold_rise_k = 60.0;
  double time_constant_s = 300.0;
  double warn_rise_k = 45.0;
  hal::Duration max_locked = std::chrono::minutes(10);  // locked for longer without a break: a warning too
};

struct BrakeHeat {
  double rise_k = 0.0;        // estimated, above ambient
  double hot_s = 0.0;         // spent above warn_rise_k so far
  double locked_s = 0.0;      // since it was last open
  bool rest_advised = false;  // hot, or locked too long: park it and take the load off
};

class BrakeHeatModel {
 public:
  explicit BrakeHeatModel(const BrakeHeatConfig& config) : config_(config) {}
  // `fraction` held since the last call. True when rest_advised has just changed.
  bool update(double fraction, hal::Instant now);
  [[nodiscard]] const BrakeHeat& state() const { return heat_; }

 private:
  BrakeHeatConfig config_;
  BrakeHeat heat_;
  std::optional<hal::Instant> last_;
};

}  // namespace forager::servo
