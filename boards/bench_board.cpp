#include "boards/bench_board.hpp"

#include <algorithm>
#include <utility>

namespace forager::boards {
namespace {

constexpr Range kPulse{500, 2500};

hal::Duration micros(ConfigReader& table, std::string_view key, hal::Duration fallback, Range allowed) {
  const double fallback_us = std::chrono::duration<double, std::micro>(fallback).count();
  return hal::from_seconds(table.number(key, fallback_us, allowed) * 1e-6);
}

std::string read_name(ConfigReader& table, std::vector<std::string>& taken) {
  table.require("name", "what it is called on the bench, such as name = \"stop_button\"");
  std::string name = table.text("name", "");
  if (name.find('/') != std::string::npos || name.find('@') != std::string::npos)
    table.complain("name", "has a / or @ in it", "These tell places from names; leave them out.");
  if (std::find(taken.begin(), taken.end(), name) != taken.end())
    table.complain("name", "is there twice", "Give every device a name of its own.");
  taken.push_back(name);
  return name;
}

BenchLine read_gpio_line(ConfigReader& table, std::vector<std::string>& taken) {
  BenchLine line;
  line.name = read_name(table, taken);
  table.require("chip", "the chip's label, such as chip = \"pinctrl-bcm2711\"");
  table.require("line", "the line's name, such as line = \"GPIO17\"");
  line.chip = table.text("chip", "");
  line.line = table.text("line", "");
  line.output = table.choice("direction", "in", {"in", "out"}) == "out";
  line.active_low = table.flag("active_low", false);
  const std::string bias = table.choice("bias", "as_is", {"as_is", "none", "pull_up", "pull_down"});
  if (bias == "none") line.bias = BenchBias::none;
  if (bias == "pull_up") line.bias = BenchBias::pull_up;
  if (bias == "pull_down") line.bias = BenchBias::pull_down;
  if (line.output) {
    const std::string drive = table.choice("drive", "push_pull", {"push_pull", "open_drain", "open_source"});
    if (drive == "open_drain") line.drive = BenchDrive::open_drain;
    if (drive == "open_source") line.drive = BenchDrive::open_source;
    line.keep_at_end = table.choice("at_end", "inactive", {"inactive", "as_is"}) == "as_is";
  } else {
    line.debounce = table.duration("debounce_ms", line.debounce, {0, 1000});
  }
  return line;
}

PwmPlace read_place(ConfigReader& table) {
  PwmPlace place;
  table.require("backend", "what makes the pulses, such as backend = \"sysfs_pwm\"");
  const std::string backend = table.choice("backend", "sim", {"sim", "sysfs_pwm", "pca9685"});
  if (backend == "sim") place.backend = PwmBackend::sim;
  if (backend == "sysfs_pwm") place.chip = table.text("chip", "pwmchip0");
  if (backend == "pca9685") {
    place.backend = PwmBackend::pca9685;
    place.bus = table.text("bus", "/dev/i2c-1");
    place.address = static_cast<std::uint8_t>(table.integer("address", place.address, {8, 119}));
  }
  table.require("channel", "the channel of the chip, such as channel = 0");
  const double most = place.backend == PwmBackend::sim ? 1.0 : backend == "pca9685" ? 15.0 : 1023.0;
  place.channel = static_cast<std::uint32_t>(table.integer("channel", 0, {0, most}));
  place.period = hal::from_seconds(1.0 / table.number("frequency_hz", 50.0, {25.0, 400.0}));
  return place;
}

BenchServo read_servo(ConfigReader& table, std::vector<std::string>& taken) {
  BenchServo servo;
  servo.name = read_name(table, taken);
  servo.place = read_place(table);
  servo.from = micros(table, "from_us", servo.from, kPulse);
  servo.to = micros(table, "to_us", servo.to, kPulse);
  servo.config.trim = micros(table, "trim_us", servo.config.trim, {-500, 500});
  servo.config.min_pulse = micros(table, "min_us", servo.config.min_pulse, kPulse);
  servo.config.max_pulse = micros(table, "max_us", servo.config.max_pulse, kPulse);
  servo.config.slew_per_s = table.number("slew_per_s", 2.0, {0.01, 1000});
  servo.config.safe = table.number("safe", 0.5, {0, 1});
  if (table.choice("at_halt", "hold", {"hold", "release"}) == "release")
    servo.config.at_halt = servo::AtHalt::release;
  if (servo.from == servo.to)
    table.complain("to_us", "is the same pulse as from_us", "Measure both: forager servo trim.");
  for (const hal::Duration pulse : {servo.from, servo.to})
    if (pulse + servo.config.trim < servo.config.min_pulse ||
        pulse + servo.config.trim > servo.config.max_pulse)
      table.complain("min_us", "and max_us cut off from_us or to_us", "Widen them, or correct the pulses.");
  return servo;
}

BenchChip read_chip(ConfigReader& table, std::vector<std::string>& taken) {
  BenchChip chip;
  chip.name = read_name(table, taken);
  chip.bus = i2c_path(table.text("bus", "/dev/i2c-1"));
  table.require("address", "the chip's address, such as address = 0x68");
  chip.address = static_cast<std::uint8_t>(table.integer("address", 0x40, {8, 119}));
  chip.timeout = table.duration("timeout_ms", chip.timeout, {1, 1000});
  return chip;
}

BenchSerial read_serial(ConfigReader& table, std::vector<std::string>& taken) {
  BenchSerial serial;
  serial.name = read_name(table, taken);
  table.require("port", "the port, best as port = \"/dev/serial/by-id/...\"");
  serial.port = table.text("port", "");
  serial.baud = static_cast<int>(table.integer("baud", serial.baud, {50, 4000000}));
  const std::string parity = table.choice("parity", "none", {"none", "even", "odd"});
  serial.parity = parity == "none" ? 'N' : parity == "even" ? 'E' : 'O';
  const std::string peer = table.choice("speaks", "nothing", {"mavlink", "text", "nothing"});
  if (peer == "mavlink") serial.peer = SerialPeer::mavlink;
  if (peer == "text") serial.peer = SerialPeer::text;
  return serial;
}

BenchWedge read_wedge(ConfigReader& table, std::vector<std::string>& taken) {
  BenchWedge wedge;
  wedge.name = read_name(table, taken);
  const auto id = [&table](std::string_view key) -> std::optional<std::uint16_t> {
    if (!table.has(key)) return std::nullopt;
    return static_cast<std::uint16_t>(table.integer(key, 0, {0, 0xFFFF}));
  };
  wedge.device.vendor = id("vendor");
  wedge.device.product = id("product");
  wedge.device.serial = table.text("serial", "");
  wedge.device.path = table.text("path", "");
  wedge.epc_digits = static_cast<std::size_t>(table.integer("epc_digits", 0, {0, 124}));
  wedge.pause = table.duration("pause_ms", wedge.pause, {10, 10000});
  return wedge;
}

void add_brake(BenchBoard& bench, const std::string& name, const BrakeLine& line, hal::Duration period) {
  BenchServo servo;
  servo.name = name;
  servo.place.period = period;
  servo.place.channel = line.channel;
  if (line.backend == BrakeBackend::sysfs_pwm) {
    servo.place.chip = line.chip;
  } else if (line.backend == BrakeBackend::pca9685) {
    servo.place.backend = PwmBackend::pca9685;
    servo.place.bus = line.bus;
    servo.place.address = line.address;
  } else {
    return;
  }
  servo.from = line.pulses.open_pulse;
  servo.to = line.pulses.locked_pulse;
  servo.config = {.safe = 1.0,
                  .slew_per_s = line.pulses.slew_per_s,
                  .trim = line.pulses.trim,
                  .min_pulse = line.pulses.min_pulse,
                  .max_pulse = line.pulses.max_pulse,
                  .at_halt = line.pulses.at_halt};
  bench.servos.push_back(std::move(servo));
}

}  // namespace

BenchBoard read_bench_board(ConfigReader& top) {
  BenchBoard board;
  std::vector<std::string> taken;
  for (ConfigReader& table : top.tables("gpio")) board.lines.push_back(read_gpio_line(table, taken));
  for (ConfigReader& table : top.tables("servo")) board.servos.push_back(read_servo(table, taken));
  for (ConfigReader& table : top.tables("i2c")) board.chips.push_back(read_chip(table, taken));
  for (ConfigReader& table : top.tables("serial")) board.serials.push_back(read_serial(table, taken));
  for (ConfigReader& table : top.tables("wedge")) board.wedges.push_back(read_wedge(table, taken));
  return board;
}

void add_brake_servos(BenchBoard& bench, const BrakeBoard& brakes) {
  if (!brakes.named) return;
  add_brake(bench, "brakes.left", brakes.left, brakes.period);
  add_brake(bench, "brakes.right", brakes.right, brakes.period);
}

}  // namespace forager::boards
