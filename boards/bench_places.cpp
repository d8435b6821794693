// What a person writes on the command line, and which device is meant.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "boards/bench_board.hpp"
#include "boards/serial_bench.hpp"

namespace forager::boards {
namespace {

template <class Device>
const Device* named(const std::vector<Device>& devices, const std::string& name) {
  const auto found = std::find_if(devices.begin(), devices.end(),
                                  [&name](const Device& device) { return device.name == name; });
  return found == devices.end() ? nullptr : &*found;
}

template <class Device>
std::string names_of(const std::vector<Device>& devices) {
  std::string names;
  for (const Device& device : devices) names += (names.empty() ? "" : ", ") + device.name;
  return names.empty() ? "The board file names none" : "The board file names " + names;
}

hal::Failure unknown(std::string_view kind, const std::string& text, std::string why, std::string mend) {
  return hal::fail(hal::ErrorCode::invalid_argument, fmt::format("{} '{}'", kind, text), "find",
                   std::move(why), std::move(mend));
}

// "BUS@ADDRESS".
bool read_bus_and_address(std::string_view text, std::string& bus, std::uint8_t& address) {
  const std::size_t at = text.rfind('@');
  if (at == std::string_view::npos || at == 0) return false;
  const auto number = parse_number(text.substr(at + 1), 0x77);
  if (!number || *number < 8) return false;
  bus = i2c_path(std::string(text.substr(0, at)));
  address = static_cast<std::uint8_t>(*number);
  return true;
}

}  // namespace

std::optional<std::uint32_t> parse_number(std::string_view text, std::uint32_t most) {
  const bool hex = text.starts_with("0x");
  if (hex) text.remove_prefix(2);
  std::uint32_t value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value, hex ? 16 : 10);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size() || text.empty() || value > most)
    return std::nullopt;
  return value;
}

std::string i2c_path(const std::string& text) {
  if (parse_number(text, 0xFFFF)) return "/dev/i2c-" + text;
  return text.starts_with("i2c-") ? "/dev/" + text : text;
}

std::string_view to_string(PwmBackend backend) {
  switch (backend) {
    case PwmBackend::sim:
      return "sim";
    case PwmBackend::sysfs:
      return "sysfs_pwm";
    case PwmBackend::pca9685:
      break;
  }
  return "pca9685";
}

std::string to_string(const PwmPlace& place) {
  switch (place.backend) {
    case PwmBackend::sim:
      return fmt::format("sim/{}", place.channel);
    case PwmBackend::sysfs:
      return fmt::format("{}/{}", place.chip, place.channel);
    case PwmBackend::pca9685:
      break;
  }
  return fmt::format("{}@0x{:02x}/{}", place.bus, place.address, place.channel);
}

hal::Result<BenchLine> find_line(const BenchBoard& board, const std::string& text) {
  if (const BenchLine* line = named(board.lines, text)) return *line;
  const std::size_t slash = text.rfind('/');
  if (slash == std::string::npos || slash == 0 || slash + 1 == text.size())
    return unknown("line", text, "is neither a name of the board file nor CHIP/LINE",
                   names_of(board.lines) + "; or write for example pinctrl-bcm2711/GPIO17");
  return BenchLine{.name = text, .chip = text.substr(0, slash), .line = text.substr(slash + 1)};
}

hal::Result<PwmPlace> find_pwm(const BenchBoard& board, const std::string& text) {
  if (const BenchServo* servo = named(board.servos, text)) return servo->place;
  const auto wrong = [&] {
    return unknown("output", text,
                   "is neither a servo of the board file, nor CHIP/CHANNEL, nor BUS@ADDRESS/CHANNEL",
                   names_of(board.servos) + "; or write for example pwmchip0/1 or /dev/i2c-1@0x40/3");
  };
  const std::size_t slash = text.rfind('/');
  if (slash == std::string::npos || slash == 0) return wrong();
  const std::string chip = text.substr(0, slash);
  PwmPlace place;
  const auto channel = parse_number(std::string_view(text).substr(slash + 1), 1023);
  if (!channel) return wrong();
  place.channel = *channel;
  if (chip == "sim") {
    place.backend = PwmBackend::sim;
  } else if (chip.find('@') != std::string::npos) {
    place.backend = PwmBackend::pca9685;
    if (!read_bus_and_address(chip, place.bus, place.address) || place.channel > 15) return wrong();
  } else {
    place.chip = chip;
  }
  return place;
}

hal::Result<BenchServo> find_servo(const BenchBoard& board, const std::string& text) {
  if (const BenchServo* servo = named(board.servos, text)) return *servo;
  return unknown("servo", text, "there is no servo of this name", names_of(board.servos));
}

hal::Result<BenchChip> find_chip(const BenchBoard& board, const std::string& text) {
  if (const BenchChip* chip = named(board.chips, text)) return *chip;
  BenchChip chip;
  chip.name = text;
  if (read_bus_and_address(text, chip.bus, chip.address)) return chip;
  return unknown("chip", text, "is neither a name of the board file nor BUS@ADDRESS",
                 names_of(board.chips) + "; or write for example 1@0x40; addresses are 0x08 to 0x77");
}

hal::Result<BenchSerial> find_serial(const BenchBoard& board, const std::string& text) {
  if (const BenchSerial* serial = named(board.serials, text)) return *serial;
  if (text.find('/') != std::string::npos) return BenchSerial{.name = text, .port = text};
  return unknown("serial line", text, "is neither a name of the board file nor the path of a port",
                 names_of(board.serials) + "; or write for example /dev/ttyUSB0");
}

hal::SerialSettings settings_of(const BenchSerial& serial) {
  return {.baud = static_cast<std::uint32_t>(serial.baud),
          .parity = serial.parity == 'E'   ? hal::Parity::even
                    : serial.parity == 'O' ? hal::Parity::odd
                                           : hal::Parity::none};
}

}  // namespace forager::boards
