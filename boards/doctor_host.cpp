#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <map>

#include "boards/doctor.hpp"
#include "hal/linux/kernel.hpp"

namespace forager::boards {
namespace {

constexpr std::string_view kArea = "host";

std::string text_of(const Doctor& doctor, const std::string& path) {
  auto text = hal::read_file(doctor.kernel, path).value_or("");
  while (!text.empty() && text.back() == '\0') text.pop_back();  // of the device tree
  return text;
}

// "6.1.21-v8+" as 6, 1.
std::array<int, 2> version_of(std::string_view release) {
  std::array<int, 2> version{};
  const auto major = std::from_chars(release.data(), release.data() + release.size(), version[0]);
  if (major.ec == std::errc() && major.ptr != release.data() + release.size() && *major.ptr == '.')
    std::from_chars(major.ptr + 1, release.data() + release.size(), version[1]);
  return version;
}

void check_kernel(const Doctor& doctor) {
  const std::string release = text_of(doctor, "/proc/sys/kernel/osrelease");
  const auto version = version_of(release);
  if (release.empty()) return doctor.skip(kArea, "kernel", "/proc says nothing of it");
  if (version < std::array{4, 8})
    return doctor.fail(kArea, "kernel", fmt::format("{} has no GPIO character device", release),
                       "Install a kernel from 4.8 on");
  if (version < std::array{5, 10})
    return doctor.warn(kArea, "kernel", fmt::format("{} cannot set a line's bias or debounce it", release),
                       "A kernel from 5.10 on does");
  doctor.ok(kArea, "kernel", release);
}

void check_real_time(const Doctor& doctor) {
  if (text_of(doctor, "/sys/kernel/realtime") == "1")
    return doctor.ok(kArea, "real time", "the kernel is PREEMPT_RT");
  doctor.warn(kArea, "real time",
              "the kernel is not PREEMPT_RT: pulses made by software may jitter under load",
              "Use hardware PWM or a PCA9685, or install linux-image-rt-arm64 (Debian)");
}

void check_governor(const Doctor& doctor) {
  std::map<std::string, int> governors;
  for (const std::string& cpu : doctor.kernel.list("/sys/devices/system/cpu"))
    if (cpu.starts_with("cpu") && cpu.size() > 3 && std::isdigit(static_cast<unsigned char>(cpu[3])) != 0)
      if (const std::string governor =
              text_of(doctor, "/sys/devices/system/cpu/" + cpu + "/cpufreq/scaling_governor");
          !governor.empty())
        ++governors[governor];
  if (governors.empty())
    return doctor.skip(kArea, "cpu governor", "the kernel does not change the CPU's clock");
  std::string text;
  for (const auto& [governor, cpus] : governors)
    text += fmt::format("{}{} on {} CPU{}", text.empty() ? "" : ", ", governor, cpus, cpus == 1 ? "" : "s");
  if (governors.size() == 1 && governors.contains("performance"))
    return doctor.ok(kArea, "cpu governor", text);
  doctor.warn(kArea, "cpu governor", text + ": the loop may be late while the clock rises",
              "echo performance | sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor");
}

void check_clock(const Doctor& doctor) {
  const auto synchronised = doctor.host.clock_synchronised();
  if (!synchronised) return doctor.skip(kArea, "clock sync", "the kernel's clock cannot be asked");
  if (*synchronised) return doctor.ok(kArea, "clock sync", "a time server keeps the clock");
  doctor.warn(kArea, "clock sync", "no time server keeps the clock: dates in inventories may be wrong",
              "sudo timedatectl set-ntp true, and give it a network; see it with timedatectl");
}

// Bits of the Raspberry Pi firmware's get_throttled: now, and (16 higher) at any time since the start.
void check_supply(const Doctor& doctor) {
  const std::string model = text_of(doctor, "/proc/device-tree/model");
  if (!model.starts_with("Raspberry Pi"))
    return doctor.skip(kArea, "supply",
                       model.empty() ? "only a Raspberry Pi tells" : model + " does not tell");
  const std::string text = text_of(doctor, "/sys/devices/platform/soc/soc:firmware/get_throttled");
  std::uint32_t bits = 0;
  const std::string_view digits = std::string_view(text).substr(text.starts_with("0x") ? 2 : 0);
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), bits, 16);
  if (text.empty() || read.ec != std::errc())
    return doctor.skip(kArea, "supply", "the firmware's get_throttled cannot be read",
                       "Ask it yourself: vcgencmd get_throttled");
  constexpr std::array<std::string_view, 4> kWords{"under-voltage", "clock capped", "throttled", "too hot"};
  std::string now;
  std::string before;
  for (std::size_t i = 0; i < kWords.size(); ++i) {
    if ((bits >> i & 1U) != 0) now += fmt::format("{}{}", now.empty() ? "" : ", ", kWords[i]);
    if ((bits >> (i + 16) & 1U) != 0) before += fmt::format("{}{}", before.empty() ? "" : ", ", kWords[i]);
  }
  const std::string mend =
      "Use a supply of 5.1 V and 3 A at the board, short thick leads, and a heat sink; servos get their own "
      "supply";
  if (!now.empty()) return doctor.fail(kArea, "supply", "right now: " + now, mend);
  if (!before.empty()) return doctor.warn(kArea, "supply", "since the start: " + before, mend);
  doctor.ok(kArea, "supply", "no under-voltage and no throttling since the start");
}

void check_user(const Doctor& doctor) {
  const DoctorHost::User user = doctor.host.user();
  if (user.root)
    return doctor.warn(kArea, "groups", "this is root, who may do everything: others may be refused",
                       "Run as the user who will run forager");
  std::string missing;
  for (const std::string_view group : {"gpio", "i2c", "dialout"})
    if (std::find(user.groups.begin(), user.groups.end(), group) == user.groups.end())
      missing += fmt::format("{}{}", missing.empty() ? "" : ",", group);
  if (missing.empty()) return doctor.ok(kArea, "groups", user.name + " is in gpio, i2c and dialout");
  doctor.warn(kArea, "groups", fmt::format("{} is not in {}", user.name, missing),
              fmt::format("sudo usermod -aG {} {}, and log in again (gpio and i2c: sudo groupadd -f first)",
                          missing, user.name));
}

void check_rules(const Doctor& doctor) {
  for (const std::string folder : {"/etc/udev/rules.d", "/usr/lib/udev/rules.d", "/lib/udev/rules.d"})
    for (const std::string& name : doctor.kernel.list(folder))
      if (name == "99-forager.rules" || name == "99-com.rules")  // of Raspberry Pi OS
        return doctor.ok(kArea, "udev rules", fmt::format("{}/{}", folder, name));
  doctor.warn(kArea, "udev rules", "neither 99-forager.rules nor 99-com.rules is installed",
              "sudo cp boards/99-forager.rules /etc/udev/rules.d/ && sudo udevadm control --reload && sudo "
              "udevadm trigger");
}

}  // namespace

void check_host(const Doctor& doctor) {
  check_kernel(doctor);
  check_real_time(doctor);
  check_governor(doctor);
  check_clock(doctor);
  check_supply(doctor);
  check_user(doctor);
  check_rules(doctor);
}

}  // namespace forager::boards
