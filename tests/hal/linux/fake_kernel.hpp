#pragma once

#include <fcntl.h>
#include <linux/i2c-dev.h>
#include <linux/i2c.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hal/i2c.hpp"
#include "hal/linux/kernel.hpp"
#include "hal/time.hpp"
#include "mocks/virtual_clock.hpp"

// A kernel in memory under the real backends: it refuses what Linux refuses, with the same errno.
namespace forager::hal::fake {

// A file of the fake kernel. Defaults refuse.
class Node {
 public:
  virtual ~Node() = default;
  virtual int open(int) { return 0; }
  virtual long read(std::string&) { return -EINVAL; }
  virtual long write(std::string_view) { return -EINVAL; }
  virtual int ioctl(unsigned long, void*) { return -ENOTTY; }
  virtual int lock() { return 0; }
  virtual void close() {}
};

class FakeKernel final : public Kernel {
 public:
  std::map<std::string, std::shared_ptr<Node>> files;
  std::map<std::string, std::string> links;
  std::vector<std::string> writes;  // "path=text", in order, of those that were taken
  std::optional<int> fail_next;     // errno of the next read, write or ioctl

  int open(const std::string& path, int flags) override {
    const auto found = files.find(path);
    if (found == files.end()) return -ENOENT;
    if (const int answer = found->second->open(flags); answer < 0) return answer;
    open_[++last_fd_] = {path, found->second};
    return last_fd_;
  }
  int close(int fd) override {
    const auto found = open_.find(fd);
    if (found == open_.end()) return -EBADF;
    found->second.second->close();
    open_.erase(found);
    return 0;
  }
  int lock(int fd) override { return open_.at(fd).second->lock(); }
  long read(int fd, std::span<char> into) override {
    if (fail_next) return -*std::exchange(fail_next, std::nullopt);
    std::string text;
    const long answer = open_.at(fd).second->read(text);
    if (answer < 0) return answer;
    const std::size_t size = std::min(text.size(), into.size());
    std::memcpy(into.data(), text.data(), size);
    return static_cast<long>(size);
  }
  long write(int fd, std::string_view text) override {
    if (fail_next) return -*std::exchange(fail_next, std::nullopt);
    const auto& [path, node] = open_.at(fd);
    if (const long answer = node->write(text); answer < 0) return answer;
    writes.push_back(path + "=" + std::string(text));
    return static_cast<long>(text.size());
  }
  int ioctl(int fd, unsigned long request, void* argument) override {
    if (fail_next) return -*std::exchange(fail_next, std::nullopt);
    return open_.at(fd).second->ioctl(request, argument);
  }
  std::vector<std::string> list(const std::string& folder) override {
    std::vector<std::string> names;
    for (const auto& [path, node] : files) {
      if (path.compare(0, folder.size() + 1, folder + "/") != 0) continue;
      const std::string name =
          path.substr(folder.size() + 1, path.find('/', folder.size() + 1) - folder.size() - 1);
      if (names.empty() || names.back() != name) names.push_back(name);
    }
    return names;
  }
  std::string link(const std::string& path) override {
    const auto found = links.find(path);
    return found == links.end() ? std::string() : found->second;
  }
  [[nodiscard]] std::size_t open_files() const { return open_.size(); }

 private:
  std::map<int, std::pair<std::string, std::shared_ptr<Node>>> open_;
  int last_fd_ = 100;
};

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

// /dev/i2c-N before an emulated bus: I2C_RDWR goes there, errors become the errno an adapter gives.
class FakeI2cNode final : public Node {
 public:
  explicit FakeI2cNode(I2c& bus) : bus_(&bus) {}
  int open_errno = 0;
  unsigned long functions = I2C_FUNC_I2C;
  long timeout_steps = 0;

  int open(int) override { return -open_errno; }
  int ioctl(unsigned long request, void* argument) override {
    if (request == I2C_FUNCS) {
      *static_cast<unsigned long*>(argument) = functions;
      return 0;
    }
    if (request == I2C_TIMEOUT) {
      timeout_steps = reinterpret_cast<long>(argument);
      return 0;
    }
    return request == I2C_RDWR ? transfer(*static_cast<i2c_rdwr_ioctl_data*>(argument)) : -ENOTTY;
  }

 private:
  static int errno_of(ErrorCode code) {
    switch (code) {
      case ErrorCode::no_ack:
        return -ENXIO;
      case ErrorCode::timeout:
        return -ETIMEDOUT;
      case ErrorCode::busy:
        return -EAGAIN;
      case ErrorCode::disconnected:
        return -ENODEV;
      default:
        return -EIO;
    }
  }
  int transfer(const i2c_rdwr_ioctl_data& data) {
    std::span<std::byte> out;
    std::span<std::byte> in;
    for (std::uint32_t i = 0; i < data.nmsgs; ++i) {
      const i2c_msg& message = data.msgs[i];
      const std::span bytes(reinterpret_cast<std::byte*>(message.buf), message.len);
      ((message.flags & I2C_M_RD) != 0 ? in : out) = bytes;
    }
    const auto address = static_cast<std::uint8_t>(data.msgs[0].addr);
    const auto done = in.empty()    ? bus_->write(address, out)
                      : out.empty() ? bus_->read(address, in)
                                    : bus_->write_read(address, out, in);
    return done ? static_cast<int>(data.nmsgs) : errno_of(done.error().code);
  }

  I2c* bus_;
};

}  // namespace forager::hal::fake
