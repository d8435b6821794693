#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "mocks/rolling_parameters.hpp"

namespace forager::mocks {

enum class BrakeFault : std::uint8_t {
  none,
  stuck_here,    // the servo stays where it is
  stuck_open,    // torn off: the pad never touches
  stuck_locked,  // jammed on the wheel
};

// One brake: a servo with dead time, slew and lag that presses a pad onto a wheel.
class RollingBrake {
 public:
  explicit RollingBrake(const RollingParameters& parameters);

  // demand: 0 open .. 1 fully pressed; what is not a number presses.
  void step(double demand);
  void set_fault(BrakeFault fault) { fault_ = fault; }
  // Pads wear, get wet: their grip as a share of what it should be.
  void set_grip(double share) { grip_ = share; }

  [[nodiscard]] double position() const { return position_; }  // 0..1 of the servo's travel
  [[nodiscard]] double force_n() const;                        // at the rim, the most it can hold

 private:
  static constexpr std::size_t kMostDead = 64;

  RollingParameters parameters_;
  double step_s_;
  double blend_;
  std::size_t dead_steps_;
  std::array<double, kMostDead> waiting_{};  // demands under way, a ring
  std::size_t at_ = 0;
  double position_ = 1.0;  // pressed at rest (sec. 6.6.2)
  double grip_ = 1.0;
  BrakeFault fault_ = BrakeFault::none;
};

}  // namespace forager::mocks
