// A machine with pins for a `forager` that runs on one without: preloaded into the program (LD_PRELOAD), it
// answers the system calls that libgpiod and the backends make, so that black-box tests see what a person
// sees at a Raspberry Pi. What the machine is like is said in the environment:
//   FORAGER_FAKE_ROOT  files below it stand for the machine's own (/sys/..., /proc/..., /dev/...)
//   FORAGER_FAKE_GPIO  words: forbidden (no permission to open the chip), loose (the wire is off)
// Where the root has a folder "levels" it holds a file for each output that was driven, with its level.
// It has one chip, gpiochip0 or "pinctrl-bcm2711", with the lines GPIO0 to GPIO27. "spi0 CS1" holds GPIO22;
// GPIO17 is wired to GPIO27.
#include <dirent.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

#include "tests/hal/linux/fake_gpio_calls.hpp"

namespace {

using forager::hal::fake::FakeGpio;

bool machine_is(std::string_view word) {
  const char* words = std::getenv("FORAGER_FAKE_GPIO");
  return words != nullptr && std::string_view(words).find(word) != std::string_view::npos;
}

const std::string& fake_root() {
  static const std::string root = [] {
    const char* text = std::getenv("FORAGER_FAKE_ROOT");
    return std::string(text == nullptr ? "" : text);
  }();
  return root;
}

std::string redirected(const char* path) {
  const std::string& root = fake_root();
  static auto* const exists = forager::hal::fake::next("access", &access);
  const std::string there = root + path;
  return !root.empty() && path[0] == '/' && exists(there.c_str(), F_OK) == 0 ? there : path;
}

void write_level(const forager::hal::fake::GpioLine& line) {
  if (!fake_root().empty()) std::ofstream(fake_root() + "/levels/" + line.name) << line.level;
}

__attribute__((constructor)) void plug_in() {
  forager::hal::fake::redirect = redirected;
  FakeGpio::driven = write_level;
  FakeGpio::Chip& chip = FakeGpio::get().chips[0];
  chip.label = "pinctrl-bcm2711";
  for (int i = 0; i < 28; ++i) chip.lines.push_back({.name = "GPIO" + std::to_string(i)});
  chip.lines[22].used = true;
  chip.lines[22].consumer = "spi0 CS1";
  if (!machine_is("loose")) chip.lines[17].wired_to = 27;
  if (machine_is("forbidden")) chip.refuse_open = EACCES;
}

}  // namespace

extern "C" {

DIR* opendir(const char* path) {
  static auto* const real = forager::hal::fake::next("opendir", &opendir);
  return real(redirected(path).c_str());
}

ssize_t readlink(const char* path, char* into, size_t size) noexcept {
  static auto* const real = forager::hal::fake::next("readlink", &readlink);
  return real(redirected(path).c_str(), into, size);
}
}
