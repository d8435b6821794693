#pragma once

#include <memory>
#include <optional>
#include <string>

#include "boards/brake_board.hpp"
#include "flight/mavlink_servos.hpp"
#include "hal/error.hpp"
#include "hal/journal.hpp"
#include "hal/time.hpp"
#include "servo/brake_actuator.hpp"

namespace forager::hal {
class Hid;
class Kernel;
}  // namespace forager::hal

namespace forager::boards {

// The two actuators of a board file's [brakes], whatever stands behind them. Owns buses, chips and lines.
class BrakeDevices {
 public:
  virtual ~BrakeDevices() = default;
  [[nodiscard]] virtual servo::BrakeActuator& left() = 0;
  [[nodiscard]] virtual servo::BrakeActuator& right() = 0;
  // What chips need besides commands: the start of a PCA9685's oscillator, its checks. Errors show at the
  // brakes' next moves too.
  [[nodiscard]] virtual hal::Result<> update(hal::Instant now) = 0;
  // "backend at place, what the hardware was told last", for people.
  [[nodiscard]] virtual std::string left_text() const = 0;
  [[nodiscard]] virtual std::string right_text() const = 0;
};

struct BrakeDeviceOptions {
  hal::Clock& clock;                           // waits for udev at opening, nothing else
  hal::Journal& journal;                       // both must outlive the devices
  flight::MavlinkServos* autopilot = nullptr;  // for backend "autopilot"
  hal::Kernel* kernel = nullptr;               // null: Linux
  hal::Hid* hid = nullptr;                     // where USB bridges are found; null: this machine
};

// Opens both, sharing what they share (one I2C bus, one PWM chip, one Modbus line). Lets go of nothing that
// an earlier program left locked: PWM by the kernel and a PCA9685 that runs go on, and a line whose brake
// locks while it is active begins active. Opens none; the brake pair that borrows them locks both. Errors:
// those of the backends; invalid_state (backend "autopilot" without one).
[[nodiscard]] hal::Result<std::unique_ptr<BrakeDevices>> open_brake_devices(
    const BrakeBoard& board, const BrakeDeviceOptions& options);

}  // namespace forager::boards
