#pragma once

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/time.hpp"
#include "tests/hal/linux/fake_kernel.hpp"

namespace forager::hal::fake {

// One PWM channel as drivers/pwm/sysfs.c and core.c keep it.
struct PwmLine {
  std::int64_t period = 0;
  std::int64_t duty = 0;
  bool enabled = false;
  bool inversed = false;
  bool exported = false;
  Instant writable_from;  // udev has given the files to the group
};

// /sys/class/pwm/pwmchipN: export makes a folder whose files are root's until udev has run; a state in which
// the duty would be longer than the period, or the period nothing, is refused with EINVAL.
class FakePwmChip {
 public:
  FakePwmChip(FakeKernel& kernel, const Clock& clock, std::string name, std::size_t lines)
      : kernel_(&kernel), clock_(&clock), folder_("/sys/class/pwm/" + name), lines_(lines) {
    add(
        "export", [this](std::string_view text) { return export_line(text); }, nullptr);
    add("npwm", nullptr, [this] { return std::to_string(lines_.size()); });
  }

  Duration udev_delay = std::chrono::milliseconds(30);
  bool gone = false;  // unplugged: every access answers ENODEV
  bool can_invert = true;
  std::int64_t shortest_ns = 1000;  // what the timer can do; the driver refuses less
  std::vector<std::size_t> taken;   // lines a driver of the kernel has
  [[nodiscard]] PwmLine& line(std::size_t index) { return lines_.at(index); }
  void export_now(std::size_t index) {
    line(index).exported = true;
    line(index).writable_from = clock_->now() + udev_delay;
    populate(index);
  }

 private:
  class Attribute final : public Node {
   public:
    std::function<long(std::string_view)> on_write;
    std::function<std::string()> on_read;
    std::function<int(int)> on_open;
    int open(int flags) override { return on_open(flags); }
    long read(std::string& into) override {
      if (!on_read) return -EIO;
      into = on_read() + "\n";
      return static_cast<long>(into.size());
    }
    long write(std::string_view text) override { return on_write ? on_write(text) : -EIO; }
  };

  // A channel's folder: one lock, of the descriptor that was first.
  class Folder final : public Node {
   public:
    int lock() override {
      if (std::exchange(locked_, true)) return ++refused_, -EAGAIN;
      return 0;
    }
    void close() override {
      if (refused_ > 0)
        --refused_;
      else
        locked_ = false;
    }

   private:
    bool locked_ = false;
    int refused_ = 0;
  };

  void add(const std::string& path, std::function<long(std::string_view)> write,
           std::function<std::string()> read, std::function<int(int)> open = nullptr) {
    auto node = std::make_shared<Attribute>();
    node->on_write = [this, write](std::string_view text) -> long {
      if (gone) return -ENODEV;
      return write ? write(text) : -EACCES;
    };
    node->on_read = std::move(read);
    node->on_open = open ? open : [](int) { return 0; };
    kernel_->files[folder_ + "/" + path] = std::move(node);
  }

  static std::optional<std::int64_t> number(std::string_view text) {
    std::int64_t value = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    if (read.ec != std::errc() || read.ptr != text.data() + text.size() || value < 0) return std::nullopt;
    return value;
  }

  long export_line(std::string_view text) {
    const auto index = number(text);
    if (!index) return -EINVAL;
    if (static_cast<std::size_t>(*index) >= lines_.size()) return -ENODEV;
    const auto line = static_cast<std::size_t>(*index);
    if (lines_[line].exported || std::count(taken.begin(), taken.end(), line) > 0) return -EBUSY;
    export_now(line);
    return 0;
  }

  // pwm_apply_state(): all or nothing.
  long apply(PwmLine& line, PwmLine wanted) const {
    if (wanted.period <= 0 || wanted.duty > wanted.period || wanted.period < shortest_ns) return -EINVAL;
    line = wanted;
    return 0;
  }

  void populate(std::size_t index) {
    PwmLine& line = lines_[index];
    const std::string folder = "pwm" + std::to_string(index) + "/";
    kernel_->files[folder_ + "/pwm" + std::to_string(index)] = std::make_shared<Folder>();
    const auto open = [this, &line](int flags) {
      return (flags & O_ACCMODE) != O_RDONLY && clock_->now() < line.writable_from ? -EACCES : 0;
    };
    const auto change = [this, &line](auto member) {
      return [this, &line, member](std::string_view text) -> long {
        const auto value = number(text);
        PwmLine wanted = line;
        if (!value) return -EINVAL;
        wanted.*member = *value;
        return apply(line, wanted);
      };
    };
    add(
        folder + "period", change(&PwmLine::period), [&line] { return std::to_string(line.period); }, open);
    add(
        folder + "duty_cycle", change(&PwmLine::duty), [&line] { return std::to_string(line.duty); }, open);
    add(
        folder + "enable",
        [this, &line](std::string_view text) -> long {
          PwmLine wanted = line;
          if (text != "0" && text != "1") return -EINVAL;
          wanted.enabled = text == "1";
          return wanted.enabled ? apply(line, wanted) : (line.enabled = false, 0);
        },
        [&line] { return std::string(line.enabled ? "1" : "0"); }, open);
    add(
        folder + "polarity",
        [this, &line](std::string_view text) -> long {
          if (text != "normal" && text != "inversed") return -EINVAL;
          if (line.enabled) return -EBUSY;
          if (line.period == 0) return -EINVAL;  // as Linux up to 6.1 at least, for a channel never used
          if (text == "inversed" && !can_invert) return -EINVAL;
          line.inversed = text == "inversed";
          return 0;
        },
        [&line] { return std::string(line.inversed ? "inversed" : "normal"); }, open);
  }

  FakeKernel* kernel_;
  const Clock* clock_;
  std::string folder_;
  std::vector<PwmLine> lines_;
};

}  // namespace forager::hal::fake
