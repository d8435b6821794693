#include "boards/brake_board.hpp"

#include <array>
#include <string>

#include "boards/modbus_board.hpp"

namespace forager::boards {
namespace {

struct BackendName {
  BrakeBackend backend;
  std::string_view name;
};
constexpr std::array kBackends{BackendName{BrakeBackend::sim, "sim"},
                               BackendName{BrakeBackend::sysfs_pwm, "sysfs_pwm"},
                               BackendName{BrakeBackend::software_pwm, "software_pwm"},
                               BackendName{BrakeBackend::pca9685, "pca9685"},
                               BackendName{BrakeBackend::gpio, "gpio"},
                               BackendName{BrakeBackend::modbus, "modbus"},
                               BackendName{BrakeBackend::autopilot, "autopilot"}};

// A brake must be locked at most 300 ms after something went wrong: slower than this it would not be.
constexpr Range kSlew{4.0, 1000.0};
// The control loop waits for every exchange. Coil, target and measured position of both brakes, each answered
// at the last moment, fit into that time, too.
constexpr Range kModbusTimeout_ms{1, 50};
constexpr Range kRegister{0, 65535};
constexpr Range kPosition{-1e9, 1e9};  // in the unit of the target register

hal::Duration micros(ConfigReader& table, std::string_view key, hal::Duration fallback, Range allowed) {
  const double fallback_us = std::chrono::duration<double, std::micro>(fallback).count();
  return hal::from_seconds(table.number(key, fallback_us, allowed) * 1e-6);
}

void read_pulses(ConfigReader& table, servo::PwmBrakeConfig& pulses) {
  constexpr Range kPulse{500, 2500};
  pulses.open_pulse = micros(table, "open_us", pulses.open_pulse, kPulse);
  pulses.locked_pulse = micros(table, "locked_us", pulses.locked_pulse, kPulse);
  pulses.trim = micros(table, "trim_us", pulses.trim, {-500, 500});
  pulses.min_pulse = micros(table, "min_us", pulses.min_pulse, kPulse);
  pulses.max_pulse = micros(table, "max_us", pulses.max_pulse, kPulse);
  pulses.slew_per_s = table.number("slew_per_s", pulses.slew_per_s, kSlew);
  if (table.choice("at_halt", "hold", {"hold", "release"}) == "release")
    pulses.at_halt = servo::AtHalt::release;
  if (pulses.open_pulse == pulses.locked_pulse)
    table.complain("locked_us", "is the same pulse as open_us", "Measure both on the bench.");
  for (const hal::Duration pulse : {pulses.open_pulse, pulses.locked_pulse})
    if (pulse + pulses.trim < pulses.min_pulse || pulse + pulses.trim > pulses.max_pulse)
      table.complain("min_us", "and max_us cut off open_us or locked_us",
                     "Widen them, or correct the pulses.");
}

void read_gpio_line(ConfigReader& table, BrakeLine& line) {
  table.require("chip", "the chip's label, such as chip = \"pinctrl-bcm2711\"");
  table.require("line", "the line's name, such as line = \"GPIO17\"");
  line.chip = table.text("chip", "");
  line.line = table.text("line", "");
  line.active_low = table.flag("active_low", false);
}

void read_gpio(ConfigReader& table, BrakeLine& line) {
  read_gpio_line(table, line);
  if (table.choice("when_active", "opens", {"opens", "locks"}) == "locks")
    line.when_active = servo::WhenActive::locks;
}

// `target = { address = 40, scale = 0.1, ... }`, or for a plain u16 `target_register = 40` alone.
void read_position(ConfigReader& table, const std::string& key, servo::ModbusRegister& position) {
  const std::string plain = key + "_register";
  if (table.has(key) && table.has(plain))
    table.complain(plain, "and " + key + " exclude each other", "Give one of them.");
  if (ConfigReader map = table.table(key); map.present()) return read_register_map(map, position);
  position.address = static_cast<std::uint16_t>(table.integer(plain, position.address, kRegister));
}

void read_modbus(ConfigReader& table, BrakeLine& line) {
  table.require("bus", "a serial port or HOST:PORT, such as bus = \"/dev/ttyUSB0\"");
  line.bus = table.text("bus", "");
  line.baud = static_cast<int>(table.integer("baud", line.baud, {1200, 921600}));
  const std::string parity = table.choice("parity", "even", {"none", "even", "odd"});
  line.parity = parity == "none" ? 'N' : parity == "even" ? 'E' : 'O';
  line.timeout = table.duration("timeout_ms", line.timeout, kModbusTimeout_ms);
  servo::ModbusBrakeConfig& actuator = line.actuator;
  const auto number = [&table](std::string_view key, std::uint16_t fallback) {
    return static_cast<std::uint16_t>(table.integer(key, fallback, kRegister));
  };
  actuator.unit = static_cast<std::uint8_t>(table.integer("unit", actuator.unit, {1, 247}));
  read_position(table, "target", actuator.target);
  actuator.open_value = table.number("open_value", actuator.open_value, kPosition);
  actuator.locked_value = table.number("locked_value", actuator.locked_value, kPosition);
  if (table.has("measured") || table.has("measured_register"))
    read_position(table, "measured",
                  actuator.measured.emplace(
                      servo::ModbusRegister{.name = "measured", .table = servo::RegisterTable::input}));
  if (table.has("enable_coil")) actuator.enable_coil = number("enable_coil", 0);
  actuator.slew_per_s = table.number("slew_per_s", actuator.slew_per_s, kSlew);
  if (actuator.open_value == actuator.locked_value)
    table.complain("locked_value", "is the same as open_value", "See the actuator's manual.");
  if (actuator.target.table == servo::RegisterTable::input)
    table.complain("target", "is an input register, which can only be read", "See the actuator's manual.");
  constexpr const char* kCorrect = "Correct it, or type and scale of target.";
  const auto open = servo::encode(actuator.target, actuator.open_value);
  if (!open) table.complain("open_value", open.error().detail, kCorrect);
  const auto locked = servo::encode(actuator.target, actuator.locked_value);
  if (!locked) table.complain("locked_value", locked.error().detail, kCorrect);
  if (open && locked && open->words == locked->words && actuator.open_value != actuator.locked_value)
    table.complain("locked_value", "is the same number as open_value in the target's register", kCorrect);
}

BrakeBackend backend_of(ConfigReader& table) {
  const std::string name = table.choice(
      "backend", "sim", {"sim", "sysfs_pwm", "software_pwm", "pca9685", "gpio", "modbus", "autopilot"});
  for (const BackendName& known : kBackends)
    if (known.name == name) return known.backend;
  return BrakeBackend::sim;
}

void read_line(ConfigReader table, BrakeLine& line) {
  table.require("backend", "what presses the brake, such as backend = \"sysfs_pwm\"");
  line.backend = backend_of(table);
  switch (line.backend) {
    case BrakeBackend::gpio:
      return read_gpio(table, line);
    case BrakeBackend::modbus:
      return read_modbus(table, line);
    case BrakeBackend::sim:
      break;
    case BrakeBackend::sysfs_pwm:
      line.chip = table.text("chip", "pwmchip0");
      table.require("channel", "the channel of the chip, such as channel = 0");
      line.channel = static_cast<std::uint32_t>(table.integer("channel", 0, {0, 1023}));
      break;
    case BrakeBackend::software_pwm:
      read_gpio_line(table, line);
      break;
    case BrakeBackend::pca9685:
      line.bus = table.text("bus", "/dev/i2c-1");
      line.address = static_cast<std::uint8_t>(table.integer("address", line.address, {8, 119}));
      table.require("channel", "the channel of the chip, such as channel = 0");
      line.channel = static_cast<std::uint32_t>(table.integer("channel", 0, {0, 15}));
      line.timeout = table.duration("timeout_ms", line.timeout, {10, 1000});
      break;
    case BrakeBackend::autopilot:
      table.require("output", "the number of the output, such as output = 9");
      line.channel = static_cast<std::uint32_t>(table.integer("output", 1, {1, 16}));
      break;
  }
  read_pulses(table, line.pulses);
}

bool overlap(const servo::ModbusRegister& a, const servo::ModbusRegister& b) {
  return a.address < b.address + servo::words_of(b.type) && b.address < a.address + servo::words_of(a.type);
}

bool same_place(const BrakeLine& a, const BrakeLine& b) {
  if (a.backend != b.backend || a.backend == BrakeBackend::sim) return false;
  if (a.backend == BrakeBackend::modbus)
    return a.bus == b.bus && a.actuator.unit == b.actuator.unit &&
           overlap(a.actuator.target, b.actuator.target);
  return a.chip == b.chip && a.bus == b.bus && a.line == b.line && a.channel == b.channel &&
         (a.backend != BrakeBackend::pca9685 || a.address == b.address);
}

}  // namespace

std::string_view to_string(BrakeBackend backend) {
  for (const BackendName& known : kBackends)
    if (known.backend == backend) return known.name;
  return "unknown";
}

hal::Duration longest_wait(const BrakeLine& line) {
  if (line.backend != BrakeBackend::modbus) return {};
  return (line.actuator.enable_coil ? 3 : 2) * line.timeout;
}

BrakeBoard read_brake_board(ConfigReader table) {
  BrakeBoard board;
  board.named = table.present();
  if (!board.named) return board;
  board.period = hal::from_seconds(1.0 / table.number("frequency_hz", 50.0, {25.0, 333.0}));
  board.pair.watch.half_track_m = table.number("half_track_m", board.pair.watch.half_track_m, {0.05, 5.0});
  board.pair.yaw_limit_rad_s = table.number("yaw_limit_rad_s", board.pair.yaw_limit_rad_s, {0.05, 10.0});
  board.pair.heat.hold_rise_k = table.number("hold_rise_k", board.pair.heat.hold_rise_k, {0.0, 500.0});
  board.pair.heat.warn_rise_k = table.number("warn_rise_k", board.pair.heat.warn_rise_k, {1.0, 500.0});
  board.pair.heat.max_locked = table.duration("max_locked_s", board.pair.heat.max_locked, {1.0, 86400.0});
  table.require("left", "the left brake, [brakes.left]");
  table.require("right", "the right brake, [brakes.right]");
  read_line(table.table("left"), board.left);
  read_line(table.table("right"), board.right);
  if (same_place(board.left, board.right))
    table.complain("right", "is the same output as left", "Every brake has an output of its own.");
  return board;
}

}  // namespace forager::boards
