#include "hal/linux/sysfs_pwm.hpp"

#include <fmt/format.h>

#include <fcntl.h>

#include <algorithm>
#include <charconv>
#include <deque>

#include "hal/linux/device_holder.hpp"

namespace forager::hal {
namespace {

constexpr std::string_view kClass = "/sys/class/pwm/";
constexpr std::string_view kPermissionMend =
    "Install boards/99-forager.rules into /etc/udev/rules.d and join the group gpio; then log in again";

std::string mend_for(ErrorCode code) {
  switch (code) {
    case ErrorCode::permission:
      return std::string(kPermissionMend);
    case ErrorCode::not_present:
      return "Enable the hardware PWM: dtoverlay=pwm-2chan on a Raspberry Pi; list with: ls /sys/class/pwm";
    case ErrorCode::busy:
      return "A driver of the kernel or another program has this channel: end it, or use another channel";
    default:
      return {};
  }
}

// A failure of sysfs, told as the channel's.
Failure told(Error error, const std::string& device, std::string_view operation) {
  error.detail = error.device + ": " + std::string(to_string(error.code));
  error.device = device;
  error.operation = operation;
  if (error.mend.empty()) error.mend = mend_for(error.code);
  return fail(std::move(error));
}

class Group;

class Channel final : public PwmChannel {
 public:
  Channel(Group& group, std::string folder, std::string name)
      : group_(&group), folder_(std::move(folder)), name_(std::move(name)) {}
  ~Channel() override;
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  Result<> prepare(const SysfsPwmConfig& config, Clock& clock, Deadline udev);
  Result<> set_period(Duration period, std::string_view operation) {
    return put("period", period.count(), operation);
  }
  [[nodiscard]] bool told_pulse_longer_than(Duration period) const { return pulse_ && *pulse_ > period; }

 private:
  Result<> do_set_pulse(Duration length) override;
  Result<> do_release() override;
  [[nodiscard]] std::optional<Duration> do_pulse() const override { return pulse_; }
  [[nodiscard]] std::string_view do_name() const override { return name_; }
  Result<> put(std::string_view attribute, std::int64_t value, std::string_view operation);
  Result<std::int64_t> get(std::string_view attribute);
  Result<> take_for_us_alone();
  Result<> adopt(const SysfsPwmConfig& config);
  Result<> keep_polarity(bool inverted);
  Result<> set_polarity(bool inverted);

  Group* group_;
  std::string folder_;
  std::string name_;
  std::optional<Duration> pulse_;
  int lock_ = -1;  // of the channel's folder
  bool enabled_ = false;
};

class Group final : public SysfsPwm {
 public:
  Group(Kernel& kernel, std::string chip, const SysfsPwmConfig& config)
      : kernel_(&kernel),
        name_("pwm " + chip),
        folder_(chip.starts_with('/') ? chip : std::string(kClass) + chip),
        period_(config.period) {
    for (const std::uint32_t index : config.channels)
      channels_.emplace_back(*this, fmt::format("{}/pwm{}", folder_, index),
                             fmt::format("pwm {}/{}", chip, index));
  }
  [[nodiscard]] Kernel& kernel() const { return *kernel_; }
  [[nodiscard]] PwmChannel& channel(std::size_t index) override { return channels_.at(index); }
  Result<> prepare(const SysfsPwmConfig& config, Clock& clock);

 private:
  Result<> do_set_period(Duration period) override;
  [[nodiscard]] Duration do_period() const override { return period_; }
  [[nodiscard]] std::string_view do_name() const override { return name_; }

  Kernel* kernel_;
  std::string name_;
  std::string folder_;
  Duration period_;
  std::deque<Channel> channels_;
};

Result<> Channel::put(std::string_view attribute, std::int64_t value, std::string_view operation) {
  const auto written =
      write_file(group_->kernel(), fmt::format("{}/{}", folder_, attribute), std::to_string(value));
  if (written) return {};
  return told(written.error(), name_, operation);
}

Result<std::int64_t> Channel::get(std::string_view attribute) {
  const auto text = read_file(group_->kernel(), fmt::format("{}/{}", folder_, attribute));
  if (!text) return told(text.error(), name_, "open");
  std::int64_t value = 0;
  const auto read = std::from_chars(text->data(), text->data() + text->size(), value);
  if (read.ec != std::errc() || read.ptr != text->data() + text->size())
    return fail(ErrorCode::protocol, name_, "open", fmt::format("{} reads \"{}\"", attribute, *text));
  return value;
}

// Between export and udev's rules the folder is missing, or its files still are root's.
Result<> Channel::prepare(const SysfsPwmConfig& config, Clock& clock, Deadline udev) {
  constexpr Duration kPause = std::chrono::milliseconds(5);
  while (true) {
    auto adopted = adopt(config);
    const bool may_change = !adopted && (adopted.error().code == ErrorCode::permission ||
                                         adopted.error().code == ErrorCode::not_present);
    if (!may_change || udev.expired(clock.now())) return adopted;
    clock.sleep_until(clock.now() + kPause);
  }
}

Channel::~Channel() {
  if (lock_ >= 0) group_->kernel().close(lock_);
}

// An exported channel is there for everybody. Whoever dies lets go of the lock.
Result<> Channel::take_for_us_alone() {
  if (lock_ >= 0) return {};
  Kernel& kernel = group_->kernel();
  const int fd = kernel.open(folder_, O_RDONLY | O_DIRECTORY);
  const int answer = fd < 0 ? fd : kernel.lock(fd);
  if (answer >= 0) {
    lock_ = fd;
    return {};
  }
  if (fd >= 0) kernel.close(fd);
  const int error = -answer;
  if (fd < 0 || error != EAGAIN)
    return fail(code_of_device_errno(error), name_, "open", folder_, mend_for(code_of_device_errno(error)),
                error);
  const std::size_t chip = folder_.rfind('/');  // the link is the chip's
  const std::string holder =
      holder_of(kernel, real_device(kernel, folder_.substr(0, chip)) + folder_.substr(chip));
  return fail(ErrorCode::busy, name_, "open",
              holder.empty() ? "another program drives this channel" : holder + " drives this channel",
              mend_for(ErrorCode::busy), error);
}

Result<> Channel::adopt(const SysfsPwmConfig& config) {
  FORAGER_TRY(take_for_us_alone());
  const auto enabled = get("enable");
  if (!enabled) return fail(enabled.error());
  enabled_ = *enabled != 0;
  if (enabled_) FORAGER_TRY(keep_polarity(config.inverted));
  const auto duty = get("duty_cycle");
  if (!duty) return fail(duty.error());
  const Duration running = std::min(Duration(*duty), config.period);
  if (running < Duration(*duty)) FORAGER_TRY(put("duty_cycle", running.count(), "open"));
  FORAGER_TRY(set_period(config.period, "open"));
  if (enabled_) pulse_ = running;
  return enabled_ ? Result<>() : set_polarity(config.inverted);
}

// What runs with the other polarity is somebody else's: its pulses would be taken for pauses.
Result<> Channel::keep_polarity(bool inverted) {
  const auto polarity = read_file(group_->kernel(), folder_ + "/polarity");
  if (!polarity && polarity.error().code == ErrorCode::not_present && !inverted)
    return {};  // it has only one
  if (!polarity) return told(polarity.error(), name_, "open");
  if ((*polarity == "inversed") == inverted) return {};
  return fail(ErrorCode::busy, name_, "open", "it makes pulses of the other polarity (" + *polarity + ")",
              "See who uses it; if nobody does: echo 0 > " + folder_ + "/enable");
}

// Changes while nothing runs, and not before there is a period.
Result<> Channel::set_polarity(bool inverted) {
  const auto polarity = write_file(group_->kernel(), folder_ + "/polarity", inverted ? "inversed" : "normal");
  const ErrorCode code = polarity ? ErrorCode::io : polarity.error().code;
  if (!polarity && (inverted || (code != ErrorCode::invalid_argument && code != ErrorCode::unsupported &&
                                 code != ErrorCode::not_present)))
    return told(polarity.error(), name_, "set polarity");
  return {};
}

Result<> Channel::do_set_pulse(Duration length) {
  if (length < Duration::zero() || length > group_->period())
    return fail(
        ErrorCode::invalid_argument, name_, "set pulse",
        fmt::format("{} ns is not from 0 to the period, {} ns", length.count(), group_->period().count()));
  FORAGER_TRY(put("duty_cycle", length.count(), "set pulse"));
  if (!enabled_) FORAGER_TRY(put("enable", 1, "set pulse"));  // last: no pulse of another length gets out
  enabled_ = true;
  pulse_ = length;
  return {};
}

Result<> Channel::do_release() {
  FORAGER_TRY(put("enable", 0, "release"));
  enabled_ = false;
  pulse_.reset();
  return {};
}

Result<> Group::prepare(const SysfsPwmConfig& config, Clock& clock) {
  const Deadline udev(clock.now(), config.settle);
  std::vector<bool> there_already;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const auto exported = write_file(*kernel_, folder_ + "/export", std::to_string(config.channels[i]));
    there_already.push_back(!exported && exported.error().code == ErrorCode::busy);
    if (exported || there_already.back()) continue;
    Error error = exported.error();  // sysfs says ENODEV for a channel the chip does not have
    if (error.code == ErrorCode::disconnected) error.code = ErrorCode::not_present;
    return told(std::move(error), std::string(channels_[i].name()), "export");
  }
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    auto prepared = channels_[i].prepare(config, clock, udev);
    if (prepared) continue;
    if (there_already[i] && prepared.error().code == ErrorCode::not_present) {
      prepared.error().code = ErrorCode::busy;  // not exported by anybody, and yet not to be had
      prepared.error().mend = mend_for(ErrorCode::busy);
    }
    return prepared;
  }
  return {};
}

Result<> Group::do_set_period(Duration period) {
  if (period <= Duration::zero())
    return fail(ErrorCode::invalid_argument, name_, "set period", "a period is longer than nothing");
  for (const Channel& channel : channels_)
    if (channel.told_pulse_longer_than(period))
      return fail(ErrorCode::invalid_argument, name_, "set period",
                  fmt::format("{} makes a pulse longer than {} ns", channel.name(), period.count()));
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    auto done = channels_[i].set_period(period, "set period");
    if (done) continue;
    for (std::size_t k = 0; k < i; ++k) static_cast<void>(channels_[k].set_period(period_, "set period"));
    return done;  // all of them as before
  }
  period_ = period;
  return {};
}

// The chip by its name in /sys/class/pwm, by that of its device, or by its path: numbers change from kernel
// to kernel.
std::string find_chip(Kernel& kernel, const std::string& wanted) {
  if (wanted.starts_with('/')) return kernel.list(wanted).empty() ? std::string() : wanted;
  for (const std::string& name : kernel.list("/sys/class/pwm")) {
    const std::string device = kernel.link(std::string(kClass) + name + "/device");
    if (name == wanted || device.substr(device.rfind('/') + 1) == wanted) return name;
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<SysfsPwm>> open_sysfs_pwm(const SysfsPwmConfig& config, Clock& clock, Kernel& kernel) {
  const std::string device = "pwm " + config.chip;
  if (config.channels.empty() || config.period <= Duration::zero())
    return fail(ErrorCode::invalid_argument, device, "open", "no channel, or a period that is not positive");
  const std::string chip = find_chip(kernel, config.chip);
  if (chip.empty())
    return fail(ErrorCode::not_present, device, "open", "there is no such PWM chip",
                mend_for(ErrorCode::not_present));
  auto group = std::make_unique<Group>(kernel, chip, config);
  FORAGER_TRY(group->prepare(config, clock));
  return group;
}

}  // namespace forager::hal
