#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "boards/bench_devices.hpp"
#include "boards/doctor.hpp"
#include "hal/linux/kernel.hpp"

namespace forager::boards {
namespace {

constexpr std::string_view kArea = "board";
constexpr std::string_view kRules =
    "Install boards/99-forager.rules into /etc/udev/rules.d and join the group gpio; then log in again";

bool is_chip(const LineFacts& line, const std::string& wanted) {
  return wanted == line.label || wanted == line.chip || wanted == "/dev/" + line.chip;
}

// Chips that are there and may not be opened: the one that is wanted may be among them.
std::vector<std::string> forbidden_chips(const Doctor& doctor) {
  std::vector<std::string> forbidden;
  for (const std::string& name : doctor.kernel.list("/dev")) {
    if (!name.starts_with("gpiochip")) continue;
    const int fd = doctor.kernel.open("/dev/" + name, O_RDWR);
    if (fd >= 0)
      doctor.kernel.close(fd);
    else if (hal::code_of_device_errno(-fd) == hal::ErrorCode::permission)
      forbidden.push_back(name);
  }
  return forbidden;
}

void forbid(const Doctor& doctor, const std::string& name, const std::string& what) {
  doctor.fail(kArea, name, what + ": the operating system forbids it [Permission denied]",
              std::string(kRules));
}

std::string chips_of(const std::vector<LineFacts>& lines) {
  std::vector<std::string> chips;
  for (const LineFacts& line : lines) {
    const std::string chip = fmt::format("{} ({})", line.label, line.chip);
    if (std::find(chips.begin(), chips.end(), chip) == chips.end()) chips.push_back(chip);
  }
  return chips.empty() ? "there is none at all" : fmt::format("there are {}", fmt::join(chips, ", "));
}

void check_line(const Doctor& doctor, const BenchLine& wanted) {
  const std::string name = "gpio " + wanted.name;
  const auto lines = doctor.machine.lines();
  if (!lines) {
    const auto forbidden = forbidden_chips(doctor);
    if (lines.error().code == hal::ErrorCode::permission && !forbidden.empty())
      return forbid(doctor, name, fmt::format("{}", fmt::join(forbidden, ", ")));
    return doctor.fail(kArea, name, lines.error());
  }
  const bool chip_there = std::any_of(lines->begin(), lines->end(),
                                      [&](const LineFacts& line) { return is_chip(line, wanted.chip); });
  if (!chip_there) {
    if (const auto forbidden = forbidden_chips(doctor); !forbidden.empty())
      return forbid(doctor, name, fmt::format("{}", fmt::join(forbidden, ", ")));
    return doctor.fail(kArea, name,
                       fmt::format("there is no GPIO chip \"{}\"; {}", wanted.chip, chips_of(*lines)),
                       "Write the label of one of them as chip = of the board file");
  }
  const auto number = parse_number(wanted.line, 0xFFFF);
  const auto line = std::find_if(lines->begin(), lines->end(), [&](const LineFacts& candidate) {
    return is_chip(candidate, wanted.chip) &&
           (number ? candidate.number == *number : candidate.name == wanted.line);
  });
  if (line == lines->end())
    return doctor.fail(kArea, name, fmt::format("{} has no line \"{}\"", wanted.chip, wanted.line),
                       "See what it has: forager gpio list --chip " + wanted.chip);
  if (!line->held_by.empty())
    return doctor.fail(
        kArea, name,
        fmt::format("{}/{}: busy, \"{}\" holds the line", wanted.chip, wanted.line, line->held_by),
        "Stop that program, or take the overlay of that driver out");
  doctor.ok(kArea, name, fmt::format("line {} of {} ({}) is free", line->number, line->chip, line->label));
}

bool writable(const Doctor& doctor, const std::string& path) {
  const int fd = doctor.kernel.open(path, O_WRONLY);
  if (fd >= 0) doctor.kernel.close(fd);
  return fd >= 0 || hal::code_of_device_errno(-fd) != hal::ErrorCode::permission;
}

void check_sysfs(const Doctor& doctor, const std::string& name, const PwmPlace& place) {
  const auto chips = doctor.machine.pwm_chips();
  if (!chips) return doctor.fail(kArea, name, chips.error());
  const auto chip = std::find_if(chips->begin(), chips->end(), [&place](const PwmFacts& candidate) {
    return candidate.chip == place.chip || candidate.device == place.chip;
  });
  if (chip == chips->end()) {
    std::vector<std::string> there;
    for (const PwmFacts& known : *chips) there.push_back(fmt::format("{} ({})", known.chip, known.device));
    return doctor.fail(kArea, name,
                       fmt::format("there is no PWM chip \"{}\"; {}", place.chip,
                                   there.empty() ? "there is none at all"
                                                 : fmt::format("there are {}", fmt::join(there, ", "))),
                       there.empty() ? "On a Raspberry Pi: dtoverlay=pwm-2chan in config.txt, and start again"
                                     : "Write the name of one of them as chip = of the board file");
  }
  if (place.channel >= chip->channels)
    return doctor.fail(kArea, name,
                       fmt::format("{} has the channels 0 to {}", chip->chip, chip->channels - 1),
                       "Correct channel = of the board file");
  const std::string folder = "/sys/class/pwm/" + chip->chip;
  if (!writable(doctor, folder + "/export") ||
      !writable(doctor, fmt::format("{}/pwm{}/duty_cycle", folder, place.channel)))
    return forbid(doctor, name, folder);
  const auto running = std::find_if(chip->exported.begin(), chip->exported.end(),
                                    [&place](const auto& line) { return line.channel == place.channel; });
  if (running == chip->exported.end() || !running->enabled)
    return doctor.ok(kArea, name, fmt::format("{} is there and makes no pulses", to_string(place)));
  doctor.ok(kArea, name,
            fmt::format("{} makes pulses of {:g} us every {:g} ms", to_string(place),
                        static_cast<double>(running->pulse.count()) / 1e3,
                        static_cast<double>(running->period.count()) / 1e6));
}

// One byte from the chip, which no register changes for: of a PCA9685 it is MODE1.
void check_chip(const Doctor& doctor, const std::string& name, const std::string& bus, std::uint8_t address,
                hal::Duration timeout, bool pca9685) {
  const auto opened = doctor.machine.open_i2c(bus, timeout);
  if (!opened) return doctor.fail(kArea, name, opened.error());
  std::byte answer{};
  const std::byte first_register{0};
  const auto read = pca9685
                        ? (*opened)->write_read(address, std::span(&first_register, 1), std::span(&answer, 1))
                        : (*opened)->read(address, std::span(&answer, 1));
  if (!read) {
    hal::Error error = read.error();
    if (error.code == hal::ErrorCode::no_ack)
      error.detail = fmt::format(
          "no chip answers at 0x{:02x}: unplugged, without power, or at another address", address);
    if (error.code == hal::ErrorCode::no_ack)
      error.mend =
          fmt::format("Check its cable, power and address straps; see who answers: forager i2c scan {}", bus);
    return doctor.fail(kArea, name, error);
  }
  doctor.ok(kArea, name, fmt::format("answers at 0x{:02x} of {}", address, bus));
}

void check_output(const Doctor& doctor, const std::string& name, const PwmPlace& place) {
  switch (place.backend) {
    case PwmBackend::sim:
      return doctor.skip(kArea, name, "emulated in this process");
    case PwmBackend::sysfs:
      return check_sysfs(doctor, name, place);
    case PwmBackend::pca9685:
      return check_chip(doctor, name, place.bus, place.address, std::chrono::milliseconds(20), true);
  }
}

void check_brake_line(const Doctor& doctor, const std::string& side, const BrakeLine& line) {
  if (line.backend == BrakeBackend::gpio || line.backend == BrakeBackend::software_pwm)
    check_line(doctor, {.name = "brakes." + side, .chip = line.chip, .line = line.line, .output = true});
}

void check_motors(const Doctor& doctor, const EscBoard& esc) {
  for (const EscMotor& motor : esc.motors) {
    PwmPlace place{.chip = esc.chip, .bus = esc.bus, .address = esc.address, .channel = motor.channel};
    if (esc.output == EscOutput::emulated) place.backend = PwmBackend::sim;
    if (esc.output == EscOutput::pca9685) place.backend = PwmBackend::pca9685;
    check_output(doctor, "esc " + motor.name, place);
  }
}

}  // namespace

void check_lines(const Doctor& doctor, const Board& board) {
  for (const BenchLine& line : board.bench.lines) {
    if (line.chip == "sim")
      doctor.skip(kArea, "gpio " + line.name, "emulated in this process");
    else
      check_line(doctor, line);
  }
  if (!board.brakes.named) return;
  check_brake_line(doctor, "left", board.brakes.left);
  check_brake_line(doctor, "right", board.brakes.right);
}

void check_outputs(const Doctor& doctor, const Board& board) {
  if (board.esc.named) check_motors(doctor, board.esc);
  for (const BenchServo& servo : board.bench.servos) check_output(doctor, "servo " + servo.name, servo.place);
  for (const BenchChip& chip : board.bench.chips) {
    if (chip.bus == "sim")
      doctor.skip(kArea, "i2c " + chip.name, "emulated in this process");
    else
      check_chip(doctor, "i2c " + chip.name, chip.bus, chip.address, chip.timeout, false);
  }
}

}  // namespace forager::boards
