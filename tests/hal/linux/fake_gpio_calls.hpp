#pragma once

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/sysmacros.h>

#include <cstdarg>
#include <string>

#include "tests/hal/linux/fake_gpio_kernel.hpp"

// Puts the fake chips under libgpiod: these functions are found before the C library's. Include it in one
// file of a test program.
namespace forager::hal::fake {

// The C library's own function of this name.
template <class Function>
Function* next(const char* name, Function*) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

// Where a file that is no fake chip is looked for instead: itself, unless a test program says otherwise.
inline std::string (*redirect)(const char* path) = nullptr;
inline std::string place_of(const char* path) { return redirect == nullptr ? path : redirect(path); }

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

// libgpiod 2 asks which subsystem a device number belongs to.
char* realpath(const char* path, char* resolved) noexcept {
  static auto* const real = forager::hal::fake::next("realpath", &realpath);
  for (const auto& [number, chip] : forager::hal::fake::FakeGpio::get().chips) {
    const std::string link = "/sys/dev/char/254:" + std::to_string(number) + "/subsystem";
    if (resolved == nullptr && link == path) return ::strdup("/sys/bus/gpio");
  }
  return real(path, resolved);
}

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  auto& gpio = forager::hal::fake::FakeGpio::get();
  if (const int number = gpio.number_of(path); number >= 0) return gpio.open(path, number);
  static auto* const real = forager::hal::fake::next("open", &open);
  return real(forager::hal::fake::place_of(path).c_str(), flags, mode);
}

int ioctl(int fd, unsigned long request, ...) noexcept {
  va_list rest;
  va_start(rest, request);
  void* argument = va_arg(rest, void*);
  va_end(rest);
  auto& gpio = forager::hal::fake::FakeGpio::get();
  static auto* const real = forager::hal::fake::next("ioctl", &ioctl);
  if (!gpio.owns(fd)) return real(fd, request, argument);
  const int error = gpio.ioctl(fd, request & 0xFFFFFFFFU, argument);  // the kernel's number has 32 bits
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
