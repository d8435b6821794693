#pragma once

#include <cstdint>
#include <optional>

#include "hal/digital_out.hpp"
#include "servo/brake_actuator.hpp"

namespace forager::servo {

// What the energised line does to the brake.
enum class WhenActive : std::uint8_t {
  opens,  // spring-applied brake: without current it locks, whatever happens to the program
  locks,  // a crash of the program leaves it as it was
};

// A solenoid or relay that either locks a brake or opens it: from one half up it locks. Its line is set when
// that changes, and every half second.
class DigitalBrake final : public BrakeActuator {
 public:
  // Borrows the line.
  DigitalBrake(hal::DigitalOut& line, WhenActive active) : line_(&line), active_(active) {}
  void halt() noexcept override;

 private:
  hal::Result<> do_move(double fraction, hal::Instant now) override;
  void do_forget() override { sent_.reset(); }
  [[nodiscard]] double do_commanded() const override { return locked_ ? 1.0 : 0.0; }
  [[nodiscard]] std::string_view do_name() const override { return line_->name(); }
  hal::Result<> lock(bool locked);

  hal::DigitalOut* line_;
  WhenActive active_;
  bool locked_ = true;
  std::optional<bool> sent_;
  std::optional<hal::Instant> refresh_at_;
};

}  // namespace forager::servo
