#pragma once

#include <cstdint>
#include <optional>

#include "hal/time.hpp"
#include "mocks/sim_modbus_slave.hpp"

namespace forager::mocks {

// A linear actuator with a position sensor and a Modbus port. It moves to its target at its own speed while
// it is enabled, stays where it is otherwise, and goes to its safe end by itself when nobody has spoken to it
// for a while.
class SimLinearActuator {
 public:
  // The registers of its manual: positions in tenths of a millimetre.
  static constexpr std::uint16_t kTarget = 40;    // holding
  static constexpr std::uint16_t kPosition = 50;  // input
  static constexpr std::uint16_t kEnable = 1;     // coil

  struct Options {
    std::uint8_t unit = 3;
    double stroke_mm = 50.0;
    double speed_mm_s = 250.0;
    std::uint16_t safe_target = 100;
    hal::Duration watchdog = std::chrono::seconds(1);
  };

  SimLinearActuator() : SimLinearActuator(Options{}) {}
  explicit SimLinearActuator(const Options& options);

  SimModbusSlave& slave() { return slave_; }
  void update(hal::Instant now);

  // The physical face.
  [[nodiscard]] double position_mm() const { return position_mm_; }
  bool jammed = false;

 private:
  Options options_;
  SimModbusSlave slave_;
  double position_mm_;
  std::uint32_t heard_ = 0;
  std::optional<hal::Instant> last_;
  std::optional<hal::Instant> spoken_to_;
};

}  // namespace forager::mocks
