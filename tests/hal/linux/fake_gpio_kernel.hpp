#pragma once

#include <dlfcn.h>
#include <fcntl.h>
#include <linux/gpio.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <map>
#include <string>
#include <vector>

#include "hal/time.hpp"

// GPIO chips of a kernel in memory under the real libgpiod: the system calls the library makes (access, open,
// stat, ioctl, close) are taken from it before the C library sees them, for paths and descriptors of the fake
// chips only. It speaks the v1 interface of linux/gpio.h, like kernels from 4.8 on. Include it in one file of
// a test program.
namespace forager::hal::fake {

struct GpioLine {
  std::string name;
  std::string consumer{};  // empty: free
  bool level = false;       // at the pin
  std::uint32_t flags = 0;  // GPIOLINE_FLAG_*
  int event_pipe = -1;      // where edges of whoever asked for them go
  bool used = false;
  std::vector<bool> history{};  // levels that were driven by an output, in order
};

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
  std::map<int, Chip> chips;  // by number: /dev/gpiochipN

  void reset() { chips.clear(); }
  [[nodiscard]] std::size_t open_handles() const { return handles_.size(); }

  // Somebody outside drives an input's pin.
  void drive(int number, std::size_t offset, bool level, Instant at) {
    GpioLine& line = chips.at(number).lines.at(offset);
    if (line.level == level) return;
    line.level = level;
    if (line.event_pipe < 0) return;
    gpioevent_data event{};
    event.timestamp = static_cast<std::uint64_t>(at.time_since_epoch().count());
    if (chips.at(number).wall_clock_stamps) event.timestamp += wall_minus_monotonic();
    const bool active = level != ((line.flags & GPIOLINE_FLAG_ACTIVE_LOW) != 0);
    event.id = active ? GPIOEVENT_EVENT_RISING_EDGE : GPIOEVENT_EVENT_FALLING_EDGE;
    int waiting = 0;
    ::ioctl(line.event_pipe, FIONREAD, &waiting);
    if (static_cast<std::size_t>(waiting) >= 16 * sizeof event) return;  // the kernel's queue is full
    static_cast<void>(!::write(line.event_pipe, &event, sizeof event));
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
    if (!handle.is_chip) return line_ioctl(chip, handle, request, static_cast<gpiohandle_data*>(argument));
    switch (request) {
      case GPIO_GET_CHIPINFO_IOCTL:
        return chip_info(chip, handle.chip, *static_cast<gpiochip_info*>(argument));
      case GPIO_GET_LINEINFO_IOCTL:
        return line_info(chip, *static_cast<gpioline_info*>(argument));
      case GPIO_GET_LINEHANDLE_IOCTL:
        return request_lines(chip, handle.chip, *static_cast<gpiohandle_request*>(argument));
      case GPIO_GET_LINEEVENT_IOCTL:
        return request_events(chip, handle.chip, *static_cast<gpioevent_request*>(argument));
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

  static std::uint64_t wall_minus_monotonic() {
    timespec wall{};
    timespec monotonic{};
    clock_gettime(CLOCK_REALTIME, &wall);
    clock_gettime(CLOCK_MONOTONIC, &monotonic);
    return static_cast<std::uint64_t>((wall.tv_sec - monotonic.tv_sec) * 1'000'000'000 + wall.tv_nsec -
                                      monotonic.tv_nsec);
  }
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
  static int line_ioctl(Chip& chip, const Handle& handle, unsigned long request, gpiohandle_data* data) {
    if (request == GPIOHANDLE_GET_LINE_VALUES_IOCTL) {
      for (std::size_t i = 0; i < handle.lines.size(); ++i) {
        const GpioLine& line = chip.lines[handle.lines[i]];
        data->values[i] = line.level != ((line.flags & GPIOLINE_FLAG_ACTIVE_LOW) != 0);
      }
      return 0;
    }
    if (request != GPIOHANDLE_SET_LINE_VALUES_IOCTL) return EINVAL;
    if (chip.fail_next_set != 0) return std::exchange(chip.fail_next_set, 0);
    ++chip.sets;
    for (std::size_t i = 0; i < handle.lines.size(); ++i)
      put(chip.lines[handle.lines[i]], data->values[i] != 0);
    return 0;
  }

  std::map<int, Handle> handles_;
};

// The C library's own function of this name.
template <class Function>
Function* next(const char* name, Function*) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace forager::hal::fake

extern "C" {

int access(const char* path, int mode) noexcept {
  if (forager::hal::fake::FakeGpio::get().number_of(path) >= 0) return 0;
  static auto* const real = forager::hal::fake::next("access", &access);
  return real(path, mode);
}

int lstat(const char* path, struct stat* status) noexcept {
  const int number = forager::hal::fake::FakeGpio::get().number_of(path);
  static auto* const real = forager::hal::fake::next("lstat", &lstat);
  if (number < 0) return real(path, status);
  *status = {};
  status->st_mode = S_IFCHR;
  status->st_rdev = makedev(254, static_cast<unsigned>(number));
  return 0;
}

int stat(const char* path, struct stat* status) noexcept {
  static auto* const real = forager::hal::fake::next("stat", &stat);
  return forager::hal::fake::FakeGpio::get().number_of(path) >= 0 ? lstat(path, status) : real(path, status);
}

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  auto& gpio = forager::hal::fake::FakeGpio::get();
  if (const int number = gpio.number_of(path); number >= 0) return gpio.open(path, number);
  static auto* const real = forager::hal::fake::next("open", &open);
  return real(path, flags, mode);
}

int ioctl(int fd, unsigned long request, ...) noexcept {
  va_list rest;
  va_start(rest, request);
  void* argument = va_arg(rest, void*);
  va_end(rest);
  auto& gpio = forager::hal::fake::FakeGpio::get();
  static auto* const real = forager::hal::fake::next("ioctl", &ioctl);
  if (!gpio.owns(fd)) return real(fd, request, argument);
  const int error = gpio.ioctl(fd, request, argument);
  if (error == 0) return 0;
  errno = error;
  return -1;
}

int close(int fd) {
  forager::hal::fake::FakeGpio::get().forget(fd);
  static auto* const real = forager::hal::fake::next("close", &close);
  return real(fd);
}
}
