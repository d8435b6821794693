#pragma once

#include <fcntl.h>
#include <linux/gpio.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hal/time.hpp"
#include "tests/hal/linux/fake_gpio_line.hpp"

// GPIO chips of a kernel in memory under the real libgpiod: the system calls the library makes (access, open,
// stat, ioctl, close) are taken from it before the C library sees them, for paths and descriptors of the fake
// chips only. It speaks the v1 interface of linux/gpio.h, like kernels from 4.8 on. Include it in one file of
// a test program.
namespace forager::hal::fake {

class FakeGpio {
 public:
  struct Chip {
    std::string label;
    std::vector<GpioLine> lines;
    int refuse_open = 0;    // errno
    int fail_next_set = 0;  // errno
    bool gone = false;      // unplugged
    bool has_bias = true;
    bool wall_clock_stamps = false;  // kernels before 5.7
    unsigned sets = 0;               // calls that set outputs
  };

  // One per process, as the descriptors are.
  static FakeGpio& get() {
    static FakeGpio gpio;
    return gpio;
  }
  std::map<int, Chip> chips;                                     // by number: /dev/gpiochipN
  static inline void (*driven)(const GpioLine& line) = nullptr;  // called for every level an output is given

  void reset() { chips.clear(); }
  [[nodiscard]] std::size_t open_handles() const { return handles_.size(); }

  // Somebody outside drives an input's pin.
  void drive(int number, std::size_t offset, bool level, Instant at) {
    GpioLine& line = chips.at(number).lines.at(offset);
    if (line.level == level) return;
    line.level = level;
    if (line.event_pipe < 0) return;
    auto stamp = static_cast<std::uint64_t>(at.time_since_epoch().count());
    if (chips.at(number).wall_clock_stamps) stamp += wall_minus_monotonic();
    const bool active = level != ((line.flags & GPIOLINE_FLAG_ACTIVE_LOW) != 0);
    gpio_v2_line_event v2{};
    v2.timestamp_ns = stamp;
    v2.id = active ? GPIO_V2_LINE_EVENT_RISING_EDGE : GPIO_V2_LINE_EVENT_FALLING_EDGE;
    v2.offset = static_cast<std::uint32_t>(offset);
    gpioevent_data v1{};
    v1.timestamp = stamp;
    v1.id = active ? GPIOEVENT_EVENT_RISING_EDGE : GPIOEVENT_EVENT_FALLING_EDGE;
    const std::size_t size = line.v2_events ? sizeof v2 : sizeof v1;
    int waiting = 0;
    ::ioctl(line.event_pipe, FIONREAD, &waiting);
    if (static_cast<std::size_t>(waiting) >= 16 * size) {  // the kernel's queue is full
      if (!line.v2_events) return;
      drop_oldest(line.event_pipe);
    }
    static_cast<void>(!::write(line.event_pipe, line.v2_events ? static_cast<void*>(&v2) : &v1, size));
  }

  // What the C library's functions ask. Nothing: not ours.
  [[nodiscard]] int number_of(const char* path) const {
    const std::string text = path;
    for (const auto& [number, chip] : chips)
      if (text == "/dev/gpiochip" + std::to_string(number) || text == dev_attribute(number)) return number;
    return -1;
  }
  [[nodiscard]] static std::string dev_attribute(int number) {
    return "/sys/bus/gpio/devices/gpiochip" + std::to_string(number) + "/dev";
  }
  int open(const char* path, int number) {
    const Chip& chip = chips.at(number);
    std::array<int, 2> ends{};
    if (path == dev_attribute(number)) {
      if (::pipe2(ends.data(), O_CLOEXEC) != 0) return -1;
      const std::string text = "254:" + std::to_string(number) + "\n";
      static_cast<void>(!::write(ends[1], text.data(), text.size()));
      ::close(ends[1]);
      return ends[0];
    }
    if (chip.refuse_open != 0) {
      errno = chip.refuse_open;
      return -1;
    }
    const int fd = spare_descriptor();
    handles_[fd] = {number, {}, -1, true};
    return fd;
  }
  [[nodiscard]] bool owns(int fd) const { return handles_.count(fd) != 0; }
  void forget(int fd) {
    const auto found = handles_.find(fd);
    if (found == handles_.end()) return;
    const Handle handle = found->second;
    handles_.erase(found);
    if (chips.count(handle.chip) == 0) return;
    for (const std::uint32_t offset : handle.lines) {
      GpioLine& line = chips.at(handle.chip).lines.at(offset);
      line.used = false;  // the level stays: what a Raspberry Pi does
      line.consumer.clear();
      line.event_pipe = -1;
    }
    if (handle.write_end >= 0) ::close(handle.write_end);
  }
  // Zero, or the errno.
  int ioctl(int fd, unsigned long request, void* argument) {
    Handle& handle = handles_.at(fd);
    if (chips.count(handle.chip) == 0 || chips.at(handle.chip).gone) return ENODEV;
    Chip& chip = chips.at(handle.chip);
    if (!handle.is_chip) return line_ioctl(chip, handle, request, argument);
    switch (request) {
      case GPIO_GET_CHIPINFO_IOCTL:
        return chip_info(chip, handle.chip, *static_cast<gpiochip_info*>(argument));
      case GPIO_GET_LINEINFO_IOCTL:
        return line_info(chip, *static_cast<gpioline_info*>(argument));
      case GPIO_GET_LINEHANDLE_IOCTL:
        return request_lines(chip, handle.chip, *static_cast<gpiohandle_request*>(argument));
      case GPIO_GET_LINEEVENT_IOCTL:
        return request_events(chip, handle.chip, *static_cast<gpioevent_request*>(argument));
      case GPIO_V2_GET_LINEINFO_IOCTL:
        return v2_line_info(chip, *static_cast<gpio_v2_line_info*>(argument));
      case GPIO_V2_GET_LINE_IOCTL:
        return v2_request(chip, handle.chip, *static_cast<gpio_v2_line_request*>(argument));
      default:
        return ENOTTY;
    }
  }

 private:
  struct Handle {
    int chip = 0;
    std::vector<std::uint32_t> lines;
    int write_end = -1;
    bool is_chip = false;
  };

  static int spare_descriptor() { return ::dup(STDERR_FILENO); }
  template <std::size_t Size>
  static void copy(char (&into)[Size], const std::string& text) {
    std::strncpy(into, text.c_str(), Size - 1);
  }
  static int chip_info(const Chip& chip, int number, gpiochip_info& info) {
    info = {};
    copy(info.name, "gpiochip" + std::to_string(number));
    copy(info.label, chip.label);
    info.lines = static_cast<std::uint32_t>(chip.lines.size());
    return 0;
  }
  static int line_info(const Chip& chip, gpioline_info& info) {
    if (info.line_offset >= chip.lines.size()) return EINVAL;
    const GpioLine& line = chip.lines[info.line_offset];
    info.flags = line.flags | (line.used ? GPIOLINE_FLAG_KERNEL : 0U);
    copy(info.name, line.name);
    copy(info.consumer, line.consumer);
    return 0;
  }
  static int admit(const Chip& chip, std::uint32_t offset, std::uint32_t flags) {
    constexpr std::uint32_t kBias =
        GPIOHANDLE_REQUEST_BIAS_PULL_UP | GPIOHANDLE_REQUEST_BIAS_PULL_DOWN | GPIOHANDLE_REQUEST_BIAS_DISABLE;
    if (offset >= chip.lines.size()) return EINVAL;
    if ((flags & kBias) != 0 && !chip.has_bias) return EINVAL;
    return chip.lines[offset].used ? EBUSY : 0;
  }
  static void take(GpioLine& line, const char* consumer, std::uint32_t flags) {
    line.used = true;
    line.consumer = consumer;
    line.v2_events = false;
    line.flags = 0;
    if ((flags & GPIOHANDLE_REQUEST_OUTPUT) != 0) line.flags |= GPIOLINE_FLAG_IS_OUT;
    if ((flags & GPIOHANDLE_REQUEST_ACTIVE_LOW) != 0) line.flags |= GPIOLINE_FLAG_ACTIVE_LOW;
    if ((flags & GPIOHANDLE_REQUEST_OPEN_DRAIN) != 0) line.flags |= GPIOLINE_FLAG_OPEN_DRAIN;
    if ((flags & GPIOHANDLE_REQUEST_BIAS_PULL_UP) != 0) {
      line.flags |= GPIOLINE_FLAG_BIAS_PULL_UP;
      line.level = true;
    }
  }
  static void put(GpioLine& line, bool active) {
    line.level = active != ((line.flags & GPIOLINE_FLAG_ACTIVE_LOW) != 0);
    line.history.push_back(line.level);
    if (driven != nullptr) driven(line);
  }
  int request_lines(Chip& chip, int number, gpiohandle_request& request) {
    for (std::uint32_t i = 0; i < request.lines; ++i)
      if (const int error = admit(chip, request.lineoffsets[i], request.flags); error != 0) return error;
    Handle handle{number, {}, -1, false};
    for (std::uint32_t i = 0; i < request.lines; ++i) {
      GpioLine& line = chip.lines[request.lineoffsets[i]];
      take(line, request.consumer_label, request.flags);
      if ((request.flags & GPIOHANDLE_REQUEST_OUTPUT) != 0) put(line, request.default_values[i] != 0);
      handle.lines.push_back(request.lineoffsets[i]);
    }
    request.fd = spare_descriptor();
    handles_[request.fd] = handle;
    return 0;
  }
  int request_events(Chip& chip, int number, gpioevent_request& request) {
    if (const int error = admit(chip, request.lineoffset, request.handleflags); error != 0) return error;
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) != 0) return errno;
    GpioLine& line = chip.lines[request.lineoffset];
    take(line, request.consumer_label, request.handleflags);
    line.event_pipe = ends[1];
    request.fd = ends[0];
    handles_[request.fd] = {number, {request.lineoffset}, ends[1], false};
    return 0;
  }
  int line_ioctl(Chip& chip, const Handle& handle, unsigned long request, void* argument) {
    auto* v1 = static_cast<gpiohandle_data*>(argument);
    auto* v2 = static_cast<gpio_v2_line_values*>(argument);
    const bool sets = request == GPIOHANDLE_SET_LINE_VALUES_IOCTL || request == GPIO_V2_LINE_SET_VALUES_IOCTL;
    const bool is_v2 = request == GPIO_V2_LINE_SET_VALUES_IOCTL || request == GPIO_V2_LINE_GET_VALUES_IOCTL;
    if (!sets && !is_v2 && request != GPIOHANDLE_GET_LINE_VALUES_IOCTL) return EINVAL;
    if (sets && chip.fail_next_set != 0) return std::exchange(chip.fail_next_set, 0);
    chip.sets += sets ? 1 : 0;
    if (is_v2 && !sets) v2->bits = 0;
    for (std::size_t i = 0; i < handle.lines.size(); ++i) {
      GpioLine& line = chip.lines[handle.lines[i]];
      const std::uint64_t bit = std::uint64_t{1} << i;
      if (is_v2 && (v2->mask & bit) == 0) continue;
      if (sets) put(line, is_v2 ? (v2->bits & bit) != 0 : v1->values[i] != 0);
      if (sets && line.wired_to >= 0)
        drive(handle.chip, static_cast<std::size_t>(line.wired_to), line.level, monotonic_now());
      if (!sets && is_v2 && is_active(line)) v2->bits |= bit;
      if (!sets && !is_v2) v1->values[i] = is_active(line) ? 1 : 0;
    }
    return 0;
  }

  static int v2_line_info(const Chip& chip, gpio_v2_line_info& info) {
    if (info.offset >= chip.lines.size()) return EINVAL;
    const GpioLine& line = chip.lines[info.offset];
    const std::uint32_t offset = info.offset;
    info = {};
    info.offset = offset;
    copy(info.name, line.name);
    copy(info.consumer, line.consumer);
    info.flags = line.used ? GPIO_V2_LINE_FLAG_USED : 0;
    for (const FlagPair& flag : kFlags)
      if (flag.shown != 0 && (line.flags & flag.shown) != 0) info.flags |= flag.v2;
    if ((line.flags & GPIOLINE_FLAG_IS_OUT) == 0) info.flags |= GPIO_V2_LINE_FLAG_INPUT;
    return 0;
  }
  int v2_request(Chip& chip, int number, gpio_v2_line_request& request) {
    std::uint64_t flags = request.config.flags;
    std::uint64_t values = 0;
    for (std::uint32_t i = 0; i < request.config.num_attrs; ++i) {
      const auto& attribute = request.config.attrs[i].attr;
      if (attribute.id == GPIO_V2_LINE_ATTR_ID_FLAGS) flags = attribute.flags;
      if (attribute.id == GPIO_V2_LINE_ATTR_ID_OUTPUT_VALUES) values = attribute.values;
    }
    std::uint32_t asked = 0;
    for (const FlagPair& flag : kFlags)
      if ((flags & flag.v2) != 0) asked |= flag.asked;
    for (std::uint32_t i = 0; i < request.num_lines; ++i)
      if (const int error = admit(chip, request.offsets[i], asked); error != 0) return error;
    Handle handle{number, {}, -1, false};
    const bool events = (flags & (GPIO_V2_LINE_FLAG_EDGE_RISING | GPIO_V2_LINE_FLAG_EDGE_FALLING)) != 0;
    std::array<int, 2> ends{-1, -1};
    if (events && ::pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) != 0) return errno;
    for (std::uint32_t i = 0; i < request.num_lines; ++i) {
      GpioLine& line = chip.lines[request.offsets[i]];
      take(line, request.consumer, asked);
      line.event_pipe = ends[1];
      line.v2_events = true;
      if ((asked & GPIOHANDLE_REQUEST_OUTPUT) != 0) put(line, (values >> i & 1U) != 0);
      handle.lines.push_back(request.offsets[i]);
    }
    handle.write_end = ends[1];
    request.fd = events ? ends[0] : spare_descriptor();
    handles_[request.fd] = handle;
    return 0;
  }

  std::map<int, Handle> handles_;
};

}  // namespace forager::hal::fake
