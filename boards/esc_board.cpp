#include "boards/esc_board.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace forager::boards {
namespace {

hal::Duration pulse(ConfigReader& table, std::string_view key, hal::Duration fallback) {
  const double fallback_us = std::chrono::duration<double, std::micro>(fallback).count();
  return hal::from_seconds(table.number(key, fallback_us, {800.0, 2200.0}) * 1e-6);
}

void read_motors(ConfigReader& table, std::vector<EscMotor>& motors) {
  if (!table.has("motor")) return;
  motors.clear();
  for (ConfigReader& entry : table.tables("motor")) {
    entry.require("name", "where it is, such as name = \"front-left\"");
    entry.require("channel", "the channel of the chip, such as channel = 0");
    EscMotor motor;
    motor.name = entry.text("name", "");
    motor.channel = static_cast<std::uint32_t>(entry.integer("channel", 0, {0, 1023}));
    const bool twice = std::any_of(motors.begin(), motors.end(), [&](const EscMotor& other) {
      return other.name == motor.name || other.channel == motor.channel;
    });
    if (twice) entry.complain("name", "or channel is used twice", "Give every motor its own.");
    motors.push_back(std::move(motor));
  }
  if (motors.empty() || motors.size() > flight::EscBank::kMost)
    table.complain("motor", "names no motor, or more than sixteen", "Name one to sixteen.");
}

void read_output(ConfigReader& table, EscBoard& board) {
  const std::string output = table.choice("output", "sysfs", {"emulated", "sysfs", "pca9685"});
  if (output == "emulated") return;
  board.output = output == "sysfs" ? EscOutput::sysfs : EscOutput::pca9685;
  if (board.output == EscOutput::sysfs) {
    board.chip = table.text("chip", board.chip);
    return;
  }
  board.bus = table.text("bus", board.bus);
  board.address = static_cast<std::uint8_t>(table.integer("address", board.address, {8, 119}));
  board.timeout = table.duration("timeout_ms", board.timeout, {10, 1000});
}

void check_channels(ConfigReader& table, const EscBoard& board) {
  if (board.output != EscOutput::pca9685) return;
  for (const EscMotor& motor : board.motors)
    if (motor.channel > 15)
      table.complain("motor", "names a channel above 15", "A PCA9685 has channels 0 to 15.");
}

void read_pulses(ConfigReader& table, flight::EscPulses& pulses) {
  if (table.choice("protocol", "pwm", {"pwm", "oneshot125"}) == "oneshot125")
    pulses.protocol = flight::EscProtocol::oneshot125;
  pulses.stop = pulse(table, "stop_us", pulses.stop);
  pulses.idle = pulse(table, "idle_us", pulses.idle);
  pulses.full = pulse(table, "full_us", pulses.full);
  pulses.high = pulse(table, "high_us", pulses.high);
}

}  // namespace

std::string output_text(const EscBoard& board) {
  switch (board.output) {
    case EscOutput::sysfs:
      return board.chip;
    case EscOutput::pca9685:
      return fmt::format("pca9685 0x{:02x} on {}", board.address, board.bus);
    case EscOutput::emulated:
      break;
  }
  return "emulated";
}

EscBoard read_esc_board(ConfigReader table) {
  EscBoard board;
  board.named = table.present();
  if (!board.named) return board;
  read_output(table, board);
  board.period = hal::from_seconds(1.0 / table.number("frequency_hz", 50.0, {50.0, 4000.0}));
  read_motors(table, board.motors);
  check_channels(table, board);
  read_pulses(table, board.bank.pulses);
  constexpr Range kRate{0.01, 100.0};
  board.bank.rise_per_s = table.number("rise_per_s", board.bank.rise_per_s, kRate);
  board.bank.fall_per_s = table.number("fall_per_s", board.bank.fall_per_s, kRate);
  board.bank.most_throttle = table.number("most_throttle", board.bank.most_throttle, {0.0, 1.0});
  const auto valid = flight::validate(board.bank, board.period);
  if (!valid)
    table.complain("frequency_hz", "and pulses do not go together: " + valid.error().detail,
                   valid.error().mend);
  return board;
}

}  // namespace forager::boards
