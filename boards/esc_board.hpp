#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "boards/config_reader.hpp"
#include "flight/esc_bank.hpp"
#include "hal/time.hpp"

namespace forager::boards {

enum class EscOutput : std::uint8_t {
  emulated,  // four SimonK ESCs and their motors in this process
  sysfs,     // a PWM chip of the kernel
  pca9685,   // a PCA9685 on I2C
};

struct EscMotor {
  std::string name;           // "front-left"
  std::uint32_t channel = 0;  // of the chip
};

// [esc] of a board file: which lines the ESCs listen to, and what their pulses mean.
struct EscBoard {
  bool named = false;  // the file has the table
  EscOutput output = EscOutput::emulated;
  std::string chip = "pwmchip0";                          // sysfs
  std::string bus = "/dev/i2c-1";                         // pca9685
  std::uint8_t address = 0x40;                            // pca9685
  hal::Duration timeout = std::chrono::milliseconds(20);  // of one exchange on I2C
  hal::Duration period = std::chrono::milliseconds(20);
  std::vector<EscMotor> motors{{"front-left", 0}, {"front-right", 1}, {"rear-left", 2}, {"rear-right", 3}};
  flight::EscBankConfig bank;
};

// "emulated", "pwmchip0", "pca9685 0x40 on /dev/i2c-1".
[[nodiscard]] std::string output_text(const EscBoard& board);

// Reads the table; mistakes become the reader's issue.
[[nodiscard]] EscBoard read_esc_board(ConfigReader table);

}  // namespace forager::boards
