#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "boards/brake_board.hpp"
#include "boards/config_reader.hpp"
#include "hal/error.hpp"
#include "hal/hid_facts.hpp"
#include "hal/time.hpp"
#include "servo/servo.hpp"

namespace forager::boards {

enum class BenchBias : std::uint8_t { as_is, none, pull_up, pull_down };
enum class BenchDrive : std::uint8_t { push_pull, open_drain, open_source };

// A GPIO line: [[gpio]] of a board file, or given as CHIP/LINE.
struct BenchLine {
  std::string name;  // of the board file; else as it was given
  std::string chip;  // label, name or path; "sim": emulated in this process
  std::string line;  // name or number
  bool output = false;
  bool active_low = false;
  BenchBias bias = BenchBias::as_is;
  BenchDrive drive = BenchDrive::push_pull;  // outputs
  hal::Duration debounce{};                  // inputs; 0: none
  bool keep_at_end = false;                  // outputs: left as it is, not made inactive
};

enum class PwmBackend : std::uint8_t { sim, sysfs, pca9685 };
[[nodiscard]] std::string_view to_string(PwmBackend backend);

// A PWM output, wherever it is.
struct PwmPlace {
  PwmBackend backend = PwmBackend::sysfs;
  std::string chip;             // sysfs: "pwmchip0", or its device's name
  std::string bus;              // pca9685: "/dev/i2c-1"
  std::uint8_t address = 0x40;  // pca9685
  std::uint32_t channel = 0;
  hal::Duration period = std::chrono::milliseconds(20);
  bool inverted = false;
  bool operator==(const PwmPlace&) const = default;
};
[[nodiscard]] std::string to_string(const PwmPlace& place);

// A servo: [[servo]], or a brake that is one.
struct BenchServo {
  std::string name;
  PwmPlace place;
  hal::Duration from = std::chrono::microseconds(1000);  // pulse at 0
  hal::Duration to = std::chrono::microseconds(2000);    // pulse at 1
  servo::ServoConfig config;
};

// A chip on an I2C bus: [[i2c]].
struct BenchChip {
  std::string name;
  std::string bus;
  std::uint8_t address = 0;
  hal::Duration timeout = std::chrono::milliseconds(20);
};

// What is expected at the other end of a serial line.
enum class SerialPeer : std::uint8_t { mavlink, text, silent };

// A serial line: [[serial]].
struct BenchSerial {
  std::string name;
  std::string port;
  int baud = 115200;
  char parity = 'N';
  SerialPeer peer = SerialPeer::silent;
};

// A reader that types what it reads as a keyboard: [[wedge]].
struct BenchWedge {
  std::string name;
  hal::HidMatch device;  // path "sim": emulated in this process
  std::size_t epc_digits = 0;
  hal::Duration pause = std::chrono::milliseconds(200);
};

// The single devices of a board file, by name.
struct BenchBoard {
  std::vector<BenchLine> lines;
  std::vector<BenchServo> servos;
  std::vector<BenchChip> chips;
  std::vector<BenchSerial> serials;
  std::vector<BenchWedge> wedges;
};

// Reads [[gpio]], [[servo]], [[i2c]], [[serial]] and [[wedge]]; mistakes become the reader's issue.
[[nodiscard]] BenchBoard read_bench_board(ConfigReader& top);

// The brakes of the same file that are servos on a PWM output of this machine, as "brakes.left" and
// "brakes.right": 0 is open, 1 and the safe place is locked.
void add_brake_servos(BenchBoard& bench, const BrakeBoard& brakes);

// A name of the board file, CHIP/LINE, or the name of a line. Errors: invalid_argument (none of these).
[[nodiscard]] hal::Result<BenchLine> find_line(const BenchBoard& board, const std::string& text);
// The name of a servo, CHIP/CHANNEL ("pwmchip0/1"), or BUS@ADDRESS/CHANNEL of a PCA9685
// ("/dev/i2c-1@0x40/3"). Errors: invalid_argument.
[[nodiscard]] hal::Result<PwmPlace> find_pwm(const BenchBoard& board, const std::string& text);
// Errors: invalid_argument, naming the servos there are.
[[nodiscard]] hal::Result<BenchServo> find_servo(const BenchBoard& board, const std::string& text);
// The name of a chip, or BUS@ADDRESS; the bus may be "1", "i2c-1" or a path. Errors: invalid_argument.
[[nodiscard]] hal::Result<BenchChip> find_chip(const BenchBoard& board, const std::string& text);
// "1", "i2c-1" or "/dev/i2c-1" as a path; "sim" stays.
[[nodiscard]] std::string i2c_path(const std::string& text);
// A whole number from 0 to `most`, decimal or 0x.
[[nodiscard]] std::optional<std::uint32_t> parse_number(std::string_view text, std::uint32_t most);

}  // namespace forager::boards
