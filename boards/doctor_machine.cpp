#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "boards/bench_devices.hpp"
#include "boards/doctor.hpp"
#include "hal/linux/hid_sysfs.hpp"
#include "hal/linux/kernel.hpp"
#include "hal/mcp2221_wire.hpp"

namespace forager::boards {
namespace {

constexpr std::string_view kArea = "machine";

void check_gpio_chips(const Doctor& doctor) {
  const auto lines = doctor.machine.lines();
  if (!lines) return doctor.fail(kArea, "gpio", lines.error());
  std::map<std::string, std::pair<std::string, int>> chips;
  for (const LineFacts& line : *lines) {
    chips[line.chip].first = line.label;
    ++chips[line.chip].second;
  }
  if (chips.empty()) return doctor.skip(kArea, "gpio", "this machine has no GPIO chips");
  for (const auto& [chip, facts] : chips)
    doctor.ok(kArea, "gpio", fmt::format("{} ({}), {} lines", chip, facts.first, facts.second));
}

void check_pwm_chips(const Doctor& doctor) {
  const auto chips = doctor.machine.pwm_chips();
  if (!chips) return doctor.fail(kArea, "pwm", chips.error());
  if (chips->empty())
    return doctor.skip(kArea, "pwm", "this machine has no PWM chips",
                       "On a Raspberry Pi: dtoverlay=pwm-2chan in config.txt, and start again");
  for (const PwmFacts& chip : *chips)
    doctor.ok(kArea, "pwm", fmt::format("{} ({}), {} channels", chip.chip, chip.device, chip.channels));
}

void check_i2c_buses(const Doctor& doctor) {
  const auto buses = doctor.machine.i2c_buses();
  if (buses.empty())
    return doctor.skip(kArea, "i2c", "this machine has no I2C bus",
                       "dtparam=i2c_arm=on on a Raspberry Pi, and sudo modprobe i2c-dev");
  doctor.ok(kArea, "i2c", fmt::format("{}", fmt::join(buses, ", ")));
}

void check_serial_ports(const Doctor& doctor) {
  std::vector<std::string> ports;
  for (const std::string& name : doctor.kernel.list("/dev"))
    if (name.starts_with("ttyUSB") || name.starts_with("ttyACM") || name.starts_with("ttyAMA"))
      ports.push_back("/dev/" + name);
  if (ports.empty()) return doctor.skip(kArea, "serial", "no USB serial adapter is plugged in");
  doctor.ok(kArea, "serial", fmt::format("{}", fmt::join(ports, ", ")));
}

void check_usb_bridge(const Doctor& doctor) {
  if (const auto held = hal::mcp2221_held_by_kernel(doctor.kernel))
    return doctor.fail(kArea, "mcp2221", held->detail, held->mend);
  for (const hal::HidNode& node : hal::list_hid_nodes(doctor.kernel))
    if (node.facts.vendor == hal::mcp2221::kVendor && node.facts.product == hal::mcp2221::kProduct)
      return doctor.ok(kArea, "mcp2221", "a USB bridge is plugged in and free");
  doctor.skip(kArea, "mcp2221", "no USB bridge is plugged in");
}

}  // namespace

void check_machine(const Doctor& doctor) {
  check_gpio_chips(doctor);
  check_pwm_chips(doctor);
  check_i2c_buses(doctor);
  check_serial_ports(doctor);
  check_usb_bridge(doctor);
}

}  // namespace forager::boards
