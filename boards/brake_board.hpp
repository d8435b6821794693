#pragma once

#include <cstdint>
#include <string>

#include "boards/config_reader.hpp"
#include "hal/time.hpp"
#include "servo/brakes.hpp"
#include "servo/digital_brake.hpp"
#include "servo/modbus_brake.hpp"
#include "servo/pwm_brake.hpp"

namespace forager::boards {

enum class BrakeBackend : std::uint8_t {
  sim,           // emulated in this process
  sysfs_pwm,     // a servo on a PWM chip of the kernel
  software_pwm,  // a servo on a GPIO line, its pulses made by a thread of this process
  pca9685,       // a servo on a PCA9685
  gpio,          // a solenoid on a GPIO line
  modbus,        // a linear actuator
  autopilot,     // a servo on an output of the autopilot
};
[[nodiscard]] std::string_view to_string(BrakeBackend backend);

// One brake: which backend, and where on it.
struct BrakeLine {
  BrakeBackend backend = BrakeBackend::sim;
  servo::PwmBrakeConfig pulses{};  // sim, sysfs_pwm, software_pwm, pca9685, autopilot
  std::string chip{};              // sysfs_pwm, software_pwm, gpio: name or label
  std::uint32_t channel = 0;       // sysfs_pwm, pca9685; autopilot: its output, from 1
  std::string bus{};               // pca9685: "/dev/i2c-1"; modbus: "/dev/ttyUSB0" or "192.168.1.30:502"
  std::uint8_t address = 0x40;     // pca9685
  std::string line{};              // software_pwm, gpio: name or number
  bool active_low = false;         // software_pwm, gpio
  servo::WhenActive when_active = servo::WhenActive::opens;  // gpio
  int baud = 19200;                                          // modbus on a serial line
  char parity = 'E';
  hal::Duration timeout = std::chrono::milliseconds(20);  // of one exchange on I2C or Modbus; the loop waits
  servo::ModbusBrakeConfig actuator{};                    // modbus
};

// [brakes] of a board file.
struct BrakeBoard {
  bool named = false;  // the file has the table
  hal::Duration period = std::chrono::milliseconds(20);
  servo::BrakePairConfig pair;
  BrakeLine left{.pulses = servo::laboratory_left()};
  BrakeLine right{.pulses = servo::laboratory_right()};
};

// How long one turn of the control loop may wait for this brake beyond its own work: for the exchanges with a
// Modbus actuator that does not answer in time. Zero for all others.
[[nodiscard]] hal::Duration longest_wait(const BrakeLine& line);

// Reads the table; mistakes become the reader's issue.
[[nodiscard]] BrakeBoard read_brake_board(ConfigReader table);

}  // namespace forager::boards
