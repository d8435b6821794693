#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "tests/scratch_folder.hpp"

namespace forager::test {

// A PWM chip of the kernel as files: /sys/class/pwm/pwmchip0 with its channels exported, in a folder of its
// own. Enough for a program that writes what Linux would take; nothing is refused.
class SysfsTree {
 public:
  explicit SysfsTree(int channels = 2) {
    std::filesystem::create_directory(chip());
    folder_.write("pwmchip0/export", "");
    for (int i = 0; i < channels; ++i) {
      const std::string channel = "pwmchip0/pwm" + std::to_string(i);
      std::filesystem::create_directory(folder_.file(channel));
      for (const char* zero : {"/enable", "/duty_cycle", "/period"}) folder_.write(channel + zero, "0\n");
      folder_.write(channel + "/polarity", "normal\n");
    }
  }
  [[nodiscard]] std::string chip() const { return folder_.file("pwmchip0"); }
  // The pulse the channel makes; nothing: none.
  [[nodiscard]] std::optional<std::int64_t> pulse_ns(int channel) const {
    const std::string at = "pwmchip0/pwm" + std::to_string(channel);
    const std::string text = folder_.read(at + "/duty_cycle");
    if (folder_.read(at + "/enable").substr(0, 1) != "1" || text.empty()) return std::nullopt;
    return std::stoll(text);
  }
  [[nodiscard]] const ScratchFolder& folder() const { return folder_; }

 private:
  ScratchFolder folder_;
};

}  // namespace forager::test
