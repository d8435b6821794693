#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "boards/bench_devices.hpp"
#include "boards/usb_bridges.hpp"
#include "hal/linux/gpio.hpp"
#include "hal/linux/i2c_dev.hpp"
#include "hal/linux/kernel.hpp"
#include "hal/linux/steady_clock.hpp"
#include "hal/linux/sysfs_pwm.hpp"
#include "servo/pca9685.hpp"

namespace forager::boards {
namespace {

hal::GpioLineConfig config_of(const BenchLine& line, hal::GpioEdges edges = hal::GpioEdges::none) {
  constexpr hal::GpioBias kBias[] = {hal::GpioBias::as_is, hal::GpioBias::none, hal::GpioBias::pull_up,
                                     hal::GpioBias::pull_down};
  constexpr hal::GpioDrive kDrive[] = {hal::GpioDrive::push_pull, hal::GpioDrive::open_drain,
                                       hal::GpioDrive::open_source};
  return {.chip = line.chip,
          .line = line.line,
          .active_low = line.active_low,
          .bias = kBias[static_cast<std::size_t>(line.bias)],
          .drive = kDrive[static_cast<std::size_t>(line.drive)],
          .edges = edges,
          .debounce = line.debounce,
          .at_end = line.keep_at_end ? hal::GpioAtEnd::as_is : hal::GpioAtEnd::inactive};
}

class SysfsOutput final : public BenchPwm {
 public:
  explicit SysfsOutput(std::unique_ptr<hal::SysfsPwm> group) : group_(std::move(group)) {}
  hal::PwmChannel& channel() override { return group_->channel(0); }
  hal::PwmGroup& group() override { return *group_; }
  hal::Result<> update(hal::Instant) override { return {}; }

 private:
  std::unique_ptr<hal::SysfsPwm> group_;
};

class ChipOutput final : public BenchPwm {
 public:
  ChipOutput(std::unique_ptr<hal::I2c> bus, hal::Journal& journal, const PwmPlace& place)
      : bus_(std::move(bus)),
        chip_(*bus_, nullptr, journal,
              {.address = place.address, .period = place.period, .inverted = place.inverted}),
        channel_(place.channel) {}
  hal::Result<> open(PwmStart start, hal::Instant now) {
    return start == PwmStart::anew ? chip_.open(now) : chip_.adopt(now);
  }
  hal::PwmChannel& channel() override { return chip_.channel(channel_); }
  hal::PwmGroup& group() override { return chip_; }
  hal::Result<> update(hal::Instant now) override { return chip_.update(now); }

 private:
  std::unique_ptr<hal::I2c> bus_;
  servo::Pca9685 chip_;
  std::uint32_t channel_;
};

class RealMachine final : public BenchMachine {
 public:
  RealMachine(hal::Journal& journal, hal::Kernel& kernel)
      : journal_(&journal), kernel_(&kernel), clock_(hal::make_steady_clock()) {}

  hal::Clock& clock() override { return *clock_; }
  bool emulated() const override { return false; }
  hal::Result<std::vector<LineFacts>> lines() override {
    auto lines = hal::list_gpio();
    if (!lines) return hal::fail(std::move(lines).error());
    std::vector<LineFacts> facts;
    for (hal::GpioLineFacts& line : *lines)
      facts.push_back({std::move(line.chip), std::move(line.label), line.number, std::move(line.name),
                       std::move(line.held_by), line.output, line.active_low});
    return facts;
  }
  hal::Result<std::unique_ptr<hal::DigitalOut>> open_out(const BenchLine& line) override {
    if (!UsbBridges::named(line.chip)) return hal::open_gpio_out(config_of(line));
    FORAGER_TRY(plain(line));
    return bridges_.output(line.chip, line.line,
                           {.active_low = line.active_low, .keep_at_end = line.keep_at_end});
  }
  hal::Result<std::unique_ptr<hal::DigitalIn>> open_in(const BenchLine& line) override {
    if (!UsbBridges::named(line.chip)) return hal::open_gpio_in(config_of(line));
    FORAGER_TRY(plain(line));
    return bridges_.input(line.chip, line.line, line.active_low);
  }
  hal::Result<std::unique_ptr<hal::EdgeIn>> open_edges(const BenchLine& line) override {
    return hal::open_gpio_edges(config_of(line, hal::GpioEdges::both));
  }
  hal::Result<std::vector<PwmFacts>> pwm_chips() override;
  hal::Result<std::unique_ptr<BenchPwm>> open_pwm(const PwmPlace& place, PwmStart start) override;
  std::vector<std::string> i2c_buses() override;
  hal::Result<std::unique_ptr<hal::I2c>> open_i2c(const std::string& bus, hal::Duration timeout) override {
    if (UsbBridges::named(bus)) return bridges_.i2c(bus, timeout);
    return hal::open_i2c_dev({.device = bus, .timeout = timeout}, *kernel_);
  }

 private:
  // A bridge's pins have no resistors, no open drain and no filter.
  [[nodiscard]] static hal::Result<> plain(const BenchLine& line) {
    const auto how = config_of(line);
    if (how.bias == hal::GpioBias::as_is && how.drive == hal::GpioDrive::push_pull &&
        how.debounce == hal::Duration::zero())
      return {};
    return hal::fail(hal::ErrorCode::unsupported, line.chip + "/" + line.line, "open",
                     "the bridge has no bias, no open drain and no debouncing", "Leave them out");
  }
  [[nodiscard]] std::int64_t number(const std::string& path) {
    const auto text = hal::read_file(*kernel_, path);
    return text ? std::strtoll(text->c_str(), nullptr, 10) : 0;
  }

  hal::Journal* journal_;
  hal::Kernel* kernel_;
  std::unique_ptr<hal::Clock> clock_;
  UsbBridges bridges_;
};

hal::Result<std::vector<PwmFacts>> RealMachine::pwm_chips() {
  std::vector<PwmFacts> chips;
  for (const std::string& name : kernel_->list("/sys/class/pwm")) {
    const std::string folder = "/sys/class/pwm/" + name;
    const std::string device = kernel_->link(folder + "/device");
    PwmFacts chip{.chip = name,
                  .device = device.substr(device.rfind('/') + 1),
                  .channels = static_cast<std::uint32_t>(number(folder + "/npwm")),
                  .exported = {}};
    for (std::uint32_t i = 0; i < chip.channels; ++i) {
      const std::string channel = fmt::format("{}/pwm{}", folder, i);
      if (!hal::read_file(*kernel_, channel + "/enable")) continue;
      chip.exported.push_back({i, number(channel + "/enable") != 0,
                               hal::Duration(number(channel + "/duty_cycle")),
                               hal::Duration(number(channel + "/period"))});
    }
    chips.push_back(std::move(chip));
  }
  return chips;
}

hal::Result<std::unique_ptr<BenchPwm>> RealMachine::open_pwm(const PwmPlace& place, PwmStart start) {
  if (place.backend == PwmBackend::pca9685) {
    auto bus = open_i2c(place.bus, std::chrono::milliseconds(20));
    if (!bus) return hal::fail(std::move(bus).error());
    auto chip = std::make_unique<ChipOutput>(*std::move(bus), *journal_, place);
    FORAGER_TRY(chip->open(start, clock_->now()));
    return chip;
  }
  if (place.backend == PwmBackend::sim)
    return hal::fail(hal::ErrorCode::invalid_argument, "pwm " + to_string(place), "open",
                     "this output is emulated, and this machine is real", "Say --board sim");
  auto group = hal::open_sysfs_pwm(
      {.chip = place.chip, .channels = {place.channel}, .inverted = place.inverted, .period = place.period},
      *clock_, *kernel_);
  if (!group) return hal::fail(std::move(group).error());
  return std::make_unique<SysfsOutput>(*std::move(group));
}

std::vector<std::string> RealMachine::i2c_buses() {
  std::vector<std::string> buses;
  for (const std::string& name : kernel_->list("/dev"))
    if (name.starts_with("i2c-")) buses.push_back("/dev/" + name);
  return buses;
}

}  // namespace

std::unique_ptr<BenchMachine> make_real_machine(hal::Journal& journal, hal::Kernel* kernel) {
  return std::make_unique<RealMachine>(journal, kernel != nullptr ? *kernel : hal::real_kernel());
}

}  // namespace forager::boards
