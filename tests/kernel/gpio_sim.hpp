#pragma once

#include <optional>
#include <string>
#include <vector>

// The kernel's gpio-sim: a chip whose lines a test sees and drives from the other side.
namespace forager::kernel {

class GpioSim {
 public:
  struct Line {
    std::string name;       // may be empty
    std::string held_by{};  // a driver of the kernel holds it as an output
  };
  GpioSim(std::string label, const std::vector<Line>& lines);
  ~GpioSim();
  GpioSim(const GpioSim&) = delete;
  GpioSim& operator=(const GpioSim&) = delete;

  [[nodiscard]] const std::string& chip() const { return chip_; }  // "gpiochip0"
  [[nodiscard]] bool level(unsigned line) const;                   // at the pin
  void drive(unsigned line, bool high) const;                      // what an input sees
  // The chip goes, as a USB adapter's does; plug_in() brings a new one of the same label.
  void unplug();
  void plug_in();

 private:
  [[nodiscard]] std::string pin(unsigned line, const char* attribute) const;

  std::string folder_;  // in configfs
  std::vector<Line> lines_;
  std::string chip_;
  std::string pins_;  // in sysfs
  bool live_ = false;
};

}  // namespace forager::kernel
