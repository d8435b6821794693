#include "hal/linux/hid_sysfs.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/input.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstdint>

namespace forager::hal {
namespace {

constexpr std::string_view kDevices = "/sys/bus/hid/devices";
constexpr std::uint16_t kMicrochip = 0x04D8;
constexpr std::uint16_t kMcp2221 = 0x00DD;

std::optional<std::uint16_t> hex16(std::string_view text) {
  std::uint16_t value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

// The value of KEY=value among the lines of a uevent file.
std::string value_of(std::string_view uevent, std::string_view key) {
  const std::string start = std::string(key) + "=";
  while (!uevent.empty()) {
    const std::string_view line = uevent.substr(0, uevent.find('\n'));
    if (line.substr(0, start.size()) == start) return std::string(line.substr(start.size()));
    uevent.remove_prefix(std::min(uevent.size(), line.size() + 1));
  }
  return {};
}

// "0003:04D8:00DD.0001": bus, vendor, product, count (Documentation/hid of the kernel).
bool read_name(std::string_view name, HidDeviceFacts& facts) {
  constexpr std::size_t kShortest = 15;
  if (name.size() < kShortest || name[4] != ':' || name[9] != ':' || name[14] != '.') return false;
  const auto vendor = hex16(name.substr(5, 4));
  const auto product = hex16(name.substr(10, 4));
  if (!vendor || !product) return false;
  facts.vendor = *vendor;
  facts.product = *product;
  return true;
}

std::vector<std::string> event_files(Kernel& kernel, const std::string& folder, bool& inputs) {
  std::vector<std::string> files;
  const std::string input_folder = folder + "/input";
  for (const std::string& input : kernel.list(input_folder)) {
    inputs = true;
    for (const std::string& name : kernel.list(fmt::format("{}/{}", input_folder, input)))
      if (name.rfind("event", 0) == 0) files.push_back("/dev/input/" + name);
  }
  return files;
}

Failure grab_failure(const HidDeviceFacts& device, const std::string& file, int error) {
  const ErrorCode code = code_of_device_errno(error);
  const bool forbidden = code == ErrorCode::permission;
  return fail(code, describe(device), "take " + file + " for this program alone",
              code == ErrorCode::busy ? "another program has it for itself"
              : forbidden             ? "the operating system forbids it"
                                      : "the kernel refuses",
              forbidden ? "Join the group input (adduser USER input), and log in again" : "", error);
}

}  // namespace

std::vector<HidNode> list_hid_nodes(Kernel& kernel) {
  std::vector<HidNode> nodes;
  for (const std::string& name : kernel.list(std::string(kDevices))) {
    HidNode node{.folder = fmt::format("{}/{}", kDevices, name), .facts = {}};
    if (!read_name(name, node.facts)) continue;
    const std::string driver = kernel.link(node.folder + "/driver");
    node.facts.driver = driver.substr(driver.find_last_of('/') + 1);
    const auto raw = kernel.list(node.folder + "/hidraw");
    if (!raw.empty()) node.facts.path = "/dev/" + raw.front();
    const std::string uevent = read_file(kernel, node.folder + "/uevent").value_or("");
    node.facts.product_name = value_of(uevent, "HID_NAME");
    node.facts.serial = value_of(uevent, "HID_UNIQ");
    nodes.push_back(std::move(node));
  }
  return nodes;
}

std::optional<Error> mcp2221_held_by_kernel(Kernel& kernel) {
  for (const HidNode& node : list_hid_nodes(kernel)) {
    const HidDeviceFacts& facts = node.facts;
    if (facts.vendor != kMicrochip || facts.product != kMcp2221) continue;
    if (facts.driver != "mcp2221" && facts.driver != "hid-mcp2221") continue;
    return Error{
        ErrorCode::busy,
        describe(facts),
        "open",
        std::string("the kernel's driver hid-mcp2221 holds the USB bridge") +
            (facts.path.empty() ? " and leaves no hidraw" : ""),
        "Either use its gpiochip and i2c adapter as those of the kernel, or: echo blacklist hid_mcp2221 | "
        "sudo tee /etc/modprobe.d/forager.conf && sudo rmmod hid_mcp2221, and plug it in again",
        0};
  }
  return std::nullopt;
}

Result<std::vector<int>> grab_inputs(Kernel& kernel, const HidDeviceFacts& device) {
  std::vector<int> grabs;
  const auto give_up = [&](Failure failure) {
    for (const int fd : grabs) kernel.close(fd);
    return failure;
  };
  for (const HidNode& node : list_hid_nodes(kernel)) {
    if (node.facts.path.empty() || node.facts.path != device.path) continue;
    bool inputs = false;
    const auto files = event_files(kernel, node.folder, inputs);
    if (inputs && files.empty())
      return fail(ErrorCode::unsupported, describe(device), "take its keys for this program alone",
                  "this kernel makes no event devices", "Load the module evdev: modprobe evdev");
    for (const std::string& file : files) {
      const int fd = kernel.open(file, O_RDONLY | O_NONBLOCK);
      if (fd < 0) return give_up(grab_failure(device, file, -fd));
      grabs.push_back(fd);
      // The argument itself is the number: 1 takes, 0 gives back, and so does closing the file.
      const int answer = kernel.ioctl(fd, EVIOCGRAB, std::bit_cast<void*>(std::intptr_t{1}));
      if (answer < 0) return give_up(grab_failure(device, file, -answer));
    }
  }
  return grabs;
}

Failure hid_open_failure(std::string device, int error) {
  const ErrorCode code = error == ENOENT ? ErrorCode::disconnected : code_of_device_errno(error);
  switch (code) {
    case ErrorCode::permission:
      return fail(
          code, std::move(device), "open", "the operating system forbids it",
          "Install boards/99-forager.rules into /etc/udev/rules.d, join the group plugdev, log in again "
          "and plug the device in again",
          error);
    case ErrorCode::disconnected:
      return fail(code, std::move(device), "open", "the plug was pulled", "Check the cable", error);
    default:
      return fail(code, std::move(device), "open", "the kernel refuses", "", error);
  }
}

}  // namespace forager::hal
