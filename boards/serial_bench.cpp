#include "boards/serial_bench.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>

#include "hal/linux/serial_port.hpp"

namespace forager::boards {
namespace {

namespace fs = std::filesystem;

// The first line of a file of the kernel; empty if there is none.
std::string first_line(const fs::path& path) {
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  return line;
}

// The name a link points at; empty for none.
std::string target_name(const fs::path& link) {
  std::error_code error;
  const fs::path target = fs::read_symlink(link, error);
  return error ? std::string() : target.filename().string();
}

// A USB device's own words stand in its folder, some levels above the port's.
std::string usb_words(const fs::path& device, const char* file) {
  std::error_code error;
  fs::path folder = fs::canonical(device, error);
  for (int level = 0; !error && level < 4 && folder.has_relative_path();
       ++level, folder = folder.parent_path())
    if (fs::exists(folder / "idVendor", error)) return first_line(folder / file);
  return {};
}

bool has_hardware(const fs::path& tty) {
  std::error_code error;
  if (!fs::exists(tty / "device" / "driver", error)) return false;
  return first_line(tty / "type") != "0";  // PORT_UNKNOWN of the 8250 driver
}

std::map<std::string, std::vector<std::string>> names_by_port(const fs::path& root) {
  std::map<std::string, std::vector<std::string>> names;
  std::error_code error;
  for (const auto& link : fs::directory_iterator(root / "dev/serial/by-id", error))
    names[target_name(link.path())].push_back("/dev/serial/by-id/" + link.path().filename().string());
  for (auto& [port, paths] : names) std::ranges::sort(paths);
  return names;
}

}  // namespace

std::vector<SerialFacts> serial_ports(const std::string& root) {
  const auto names = names_by_port(root);
  std::vector<SerialFacts> ports;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(fs::path(root) / "sys/class/tty", error)) {
    if (!has_hardware(entry.path())) continue;
    const std::string name = entry.path().filename().string();
    SerialFacts facts{.device = "/dev/" + name,
                      .driver = target_name(entry.path() / "device" / "driver"),
                      .product = usb_words(entry.path() / "device", "product"),
                      .serial = usb_words(entry.path() / "device", "serial")};
    if (const auto found = names.find(name); found != names.end()) facts.by_id = found->second;
    ports.push_back(std::move(facts));
  }
  std::ranges::sort(ports, {}, &SerialFacts::device);
  return ports;
}

std::unique_ptr<hal::SerialPort> serial_line(const std::string& device, const hal::SerialSettings& settings,
                                             const hal::Clock& clock) {
  hal::SerialPortConfig config;
  config.device = device;
  config.line = settings;
  return hal::open_serial_port(config, clock);
}

}  // namespace forager::boards
