#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "hal/modbus.hpp"
#include "servo/brake_actuator.hpp"
#include "servo/modbus_register.hpp"

namespace forager::servo {

// Where a linear actuator keeps its position, as its manual says.
struct ModbusBrakeConfig {
  std::uint8_t unit = 1;
  ModbusRegister target{.name = "target"};  // holding
  double open_value = 0.0;                  // in the unit of the target
  double locked_value = 1000.0;
  std::optional<ModbusRegister> measured{};    // position in the same unit; none: no sensor
  std::optional<std::uint16_t> enable_coil{};  // switched on before the first target
  double slew_per_s = 4.0;                     // travels per second
  // The bus is slow: the measured position is read no more often than this.
  hal::Duration poll_interval = std::chrono::milliseconds(100);
  // Coil and target are written again this often, for an actuator that lost its supply for a moment.
  hal::Duration refresh = std::chrono::milliseconds(500);
};

// A linear actuator on Modbus that presses a brake. A target is written when it changes, after a failure and
// every refresh. Each move() waits for at most one write and one read on the bus, and for one more write
// where a coil enables it, each for up to the time-out of the bus: whoever must lock within a given time
// chooses that accordingly. halt() waits for the writes. After a crash the actuator stays where it is: choose
// one whose own time-out locks it.
class ModbusBrake final : public BrakeActuator {
 public:
  // Borrows the bus. Errors: invalid_argument (open and locked the same, or beyond what the target holds; the
  // target cannot be written; slew or refresh not positive).
  [[nodiscard]] static hal::Result<ModbusBrake> create(hal::Modbus& bus, const ModbusBrakeConfig& config);
  void halt() noexcept override;

 private:
  ModbusBrake(hal::Modbus& bus, const ModbusBrakeConfig& config);
  hal::Result<> do_move(double fraction, hal::Instant now) override;
  hal::Result<> do_jump(double fraction, hal::Instant now) override;
  void do_forget() override;
  [[nodiscard]] double do_commanded() const override { return place_; }
  [[nodiscard]] std::optional<double> do_measured() const override { return measured_; }
  [[nodiscard]] std::string_view do_name() const override { return name_; }
  hal::Result<> tell(double place, hal::Instant now);
  hal::Result<> send(double place);
  hal::Result<> measure(hal::Instant now);

  hal::Modbus* bus_;
  ModbusBrakeConfig config_;
  std::string name_;
  double place_ = 1.0;
  std::optional<std::array<std::uint16_t, 2>> sent_;
  std::optional<double> measured_;
  std::optional<hal::Instant> last_;
  std::optional<hal::Instant> next_poll_;
  std::optional<hal::Instant> refresh_at_;
  bool enabled_ = false;
};

}  // namespace forager::servo
