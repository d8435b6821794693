#include "boards/brake_devices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>
#include <vector>

#include "boards/board.hpp"
#include "boards/usb_bridges.hpp"
#include "hal/linux/gpio.hpp"
#include "hal/linux/i2c_dev.hpp"
#include "hal/linux/kernel.hpp"
#include "hal/linux/modbus_bus.hpp"
#include "hal/linux/software_pwm.hpp"
#include "hal/linux/sysfs_pwm.hpp"
#include "mocks/fake_pwm.hpp"
#include "servo/pca9685.hpp"

namespace forager::boards {
namespace {

// What stands between a brake and the machine; shared by both where the board file names the same.
struct Hardware {
  std::unique_ptr<hal::SysfsPwm> sysfs;
  std::unique_ptr<hal::I2c> i2c;
  std::unique_ptr<servo::Pca9685> pca9685;
  std::unique_ptr<hal::Modbus> modbus;
  std::unique_ptr<hal::DigitalOut> gpio;
  std::unique_ptr<mocks::FakePwmGroup> emulated;
};

struct Brake {
  std::unique_ptr<servo::BrakeActuator> actuator;
  const hal::PwmChannel* channel = nullptr;  // where it has one
  std::string place;

  [[nodiscard]] std::string text() const {
    if (channel == nullptr) return fmt::format("{}, {:.2f}", place, actuator->commanded());
    const auto pulse = channel->pulse();
    return pulse ? fmt::format("{}, {:.1f} us", place, static_cast<double>(pulse->count()) / 1e3)
                 : fmt::format("{}, no pulses", place);
  }
};

constexpr hal::Duration kStale = std::chrono::milliseconds(150);

// Where servo::PwmBrake sends the servo to lock it.
hal::Duration safe_pulse(const servo::PwmBrakeConfig& pulses) {
  return std::clamp(pulses.locked_pulse + pulses.trim, pulses.min_pulse, pulses.max_pulse);
}

class Devices final : public BrakeDevices {
 public:
  explicit Devices(const BrakeDeviceOptions& options) : options_(options), bridges_(options.hid) {}
  ~Devices() override { note_jitter(); }
  Devices(const Devices&) = delete;
  Devices& operator=(const Devices&) = delete;

  hal::Result<> open(const BrakeBoard& board);
  servo::BrakeActuator& left() override { return *left_.actuator; }
  servo::BrakeActuator& right() override { return *right_.actuator; }
  hal::Result<> update(hal::Instant now) override;
  std::string left_text() const override { return left_.text(); }
  std::string right_text() const override { return right_.text(); }

 private:
  hal::Result<> open_brake(const BrakeBoard& board, const BrakeLine& line, Hardware& own, Hardware& other,
                           Brake& brake);
  hal::Result<> attach(hal::PwmChannel& channel, const BrakeLine& line, Brake& brake);
  hal::Result<> open_sysfs(const BrakeBoard& board, const BrakeLine& line, Hardware& own, Brake& brake);
  hal::Result<> open_pca9685(const BrakeBoard& board, const BrakeLine& line, Hardware& own, Hardware& other,
                             Brake& brake);
  hal::Result<> open_modbus(const BrakeLine& line, Hardware& own, Hardware& other, Brake& brake);
  hal::Result<> open_gpio(const BrakeLine& line, Hardware& own, Brake& brake);
  hal::Result<> open_software(const BrakeBoard& board);
  void note_jitter() noexcept;
  [[nodiscard]] hal::Kernel& kernel() const {
    return options_.kernel != nullptr ? *options_.kernel : hal::real_kernel();
  }

  BrakeDeviceOptions options_;
  UsbBridges bridges_;                          // before what stands on them
  std::unique_ptr<hal::SoftwarePwm> software_;  // one thread for both
  Hardware left_hardware_;                      // before the brakes, which borrow it
  Hardware right_hardware_;
  Brake left_;
  Brake right_;
  std::string shared_bus_;
  std::uint8_t shared_address_ = 0;
};

hal::Result<> Devices::open(const BrakeBoard& board) {
  FORAGER_TRY(open_software(board));
  FORAGER_TRY(open_brake(board, board.left, left_hardware_, right_hardware_, left_));
  return open_brake(board, board.right, right_hardware_, left_hardware_, right_);
}

hal::Result<> Devices::attach(hal::PwmChannel& channel, const BrakeLine& line, Brake& brake) {
  auto made = servo::PwmBrake::create(channel, line.pulses);
  if (!made) return hal::fail(std::move(made).error());
  brake.actuator = std::make_unique<servo::PwmBrake>(*std::move(made));
  brake.channel = &channel;
  brake.place = channel.name();
  return {};
}

hal::Result<> Devices::open_sysfs(const BrakeBoard& board, const BrakeLine& line, Hardware& own,
                                  Brake& brake) {
  auto group = hal::open_sysfs_pwm({.chip = line.chip, .channels = {line.channel}, .period = board.period},
                                   options_.clock, kernel());
  if (!group) return hal::fail(std::move(group).error());
  own.sysfs = *std::move(group);
  return attach(own.sysfs->channel(0), line, brake);
}

hal::Result<> Devices::open_pca9685(const BrakeBoard& board, const BrakeLine& line, Hardware& own,
                                    Hardware& other, Brake& brake) {
  const bool shared = other.pca9685 && shared_bus_ == line.bus && shared_address_ == line.address;
  if (shared) return attach(other.pca9685->channel(line.channel), line, brake);
  auto bus = UsbBridges::named(line.bus)
                 ? bridges_.i2c(line.bus, line.timeout)
                 : hal::open_i2c_dev({.device = line.bus, .timeout = line.timeout}, kernel());
  if (!bus) return hal::fail(std::move(bus).error());
  own.i2c = *std::move(bus);
  own.pca9685 =
      std::make_unique<servo::Pca9685>(*own.i2c, nullptr, options_.journal,
                                       servo::Pca9685Config{.address = line.address, .period = board.period});
  shared_bus_ = line.bus;
  shared_address_ = line.address;
  FORAGER_TRY(own.pca9685->adopt(options_.clock.now()));  // one that holds a brake locked goes on
  return attach(own.pca9685->channel(line.channel), line, brake);
}

// While the program hangs the thread goes on: it then locks the brakes by itself.
hal::Result<> Devices::open_software(const BrakeBoard& board) {
  std::vector<hal::SoftwarePwmLine> lines;
  hal::Duration patience = kStale;
  for (const BrakeLine* line : {&board.left, &board.right}) {
    patience += longest_wait(*line);
    if (line->backend != BrakeBackend::software_pwm) continue;
    auto out = hal::open_gpio_out({.chip = line->chip, .line = line->line, .active_low = line->active_low});
    if (!out) return hal::fail(std::move(out).error());
    lines.push_back({*std::move(out), safe_pulse(line->pulses)});
  }
  if (lines.empty()) return {};
  auto pwm = hal::open_software_pwm(std::move(lines), {.period = board.period, .stale_after = patience});
  if (!pwm) return hal::fail(std::move(pwm).error());
  software_ = *std::move(pwm);
  options_.journal.note(options_.clock.now(), "software pwm", software_->facts().text);
  return {};
}

void Devices::note_jitter() noexcept {
  if (!software_ || software_->pulse_jitter().count() == 0) return;
  try {
    const auto us = [](hal::Duration time) { return static_cast<double>(time.count()) / 1e3; };
    const hal::Jitter& late = software_->pulse_jitter();
    options_.journal.note(
        options_.clock.now(), "software pwm",
        fmt::format(
            "{} pulses, too long by {:.1f} us (median), {:.1f} us (99 %), {:.1f} us (most); {} periods "
            "missed",
            late.count(), us(late.quantile(0.5)), us(late.quantile(0.99)), us(late.max()),
            software_->missed_periods()));
  } catch (const std::exception&) {  // no memory for a note is no reason not to end
    return;
  }
}

hal::Result<> Devices::open_modbus(const BrakeLine& line, Hardware& own, Hardware& other, Brake& brake) {
  const bool shared = other.modbus && shared_bus_ == line.bus;
  if (!shared) {
    const auto endpoint = endpoint_from(line.bus);  // a serial port has no colon
    auto bus =
        endpoint
            ? hal::open_modbus_tcp({.host = endpoint->host, .port = endpoint->port, .timeout = line.timeout})
            : hal::open_modbus_rtu(
                  {.device = line.bus, .baud = line.baud, .parity = line.parity, .timeout = line.timeout});
    if (!bus) return hal::fail(std::move(bus).error());
    own.modbus = *std::move(bus);
    shared_bus_ = line.bus;
  }
  auto made = servo::ModbusBrake::create(shared ? *other.modbus : *own.modbus, line.actuator);
  if (!made) return hal::fail(std::move(made).error());
  brake.actuator = std::make_unique<servo::ModbusBrake>(*std::move(made));
  brake.place = brake.actuator->name();
  return {};
}

// Neither the beginning nor the end of the program may let a brake go: a spring-applied one locks inactive,
// the other kind locks active, from the request of its line on, and keeps it.
hal::Result<> Devices::open_gpio(const BrakeLine& line, Hardware& own, Brake& brake) {
  const bool opens = line.when_active == servo::WhenActive::opens;
  auto out =
      UsbBridges::named(line.chip)
          ? bridges_.output(line.chip, line.line,
                            {.active_low = line.active_low, .keep_at_end = !opens, .begin_active = !opens})
          : hal::open_gpio_out({.chip = line.chip,
                                .line = line.line,
                                .active_low = line.active_low,
                                .begin_active = !opens,
                                .at_end = opens ? hal::GpioAtEnd::inactive : hal::GpioAtEnd::as_is});
  if (!out) return hal::fail(std::move(out).error());
  own.gpio = *std::move(out);
  brake.actuator = std::make_unique<servo::DigitalBrake>(*own.gpio, line.when_active);
  brake.place = own.gpio->name();
  return {};
}

hal::Result<> Devices::open_brake(const BrakeBoard& board, const BrakeLine& line, Hardware& own,
                                  Hardware& other, Brake& brake) {
  switch (line.backend) {
    case BrakeBackend::sysfs_pwm:
      return open_sysfs(board, line, own, brake);
    case BrakeBackend::software_pwm: {
      const bool second = &brake == &right_ && board.left.backend == BrakeBackend::software_pwm;
      return attach(software_->channel(second ? 1 : 0), line, brake);
    }
    case BrakeBackend::pca9685:
      return open_pca9685(board, line, own, other, brake);
    case BrakeBackend::gpio:
      return open_gpio(line, own, brake);
    case BrakeBackend::modbus:
      return open_modbus(line, own, other, brake);
    case BrakeBackend::autopilot:
      if (options_.autopilot == nullptr)
        return hal::fail(hal::ErrorCode::invalid_state, "brakes", "open", "there is no autopilot to ask");
      return attach(options_.autopilot->output(line.channel), line, brake);
    case BrakeBackend::sim:
      break;
  }
  own.emulated = std::make_unique<mocks::FakePwmGroup>(&brake == &left_ ? "emulated left" : "emulated right",
                                                       1, board.period);
  return attach(own.emulated->channel(0), line, brake);
}

hal::Result<> Devices::update(hal::Instant now) {
  if (software_) software_->feed();
  hal::Result<> first;  // all live, whatever happens to the others
  for (Hardware* hardware : {&left_hardware_, &right_hardware_}) {
    if (!hardware->pca9685) continue;
    if (auto updated = hardware->pca9685->update(now); !updated && first) first = std::move(updated);
  }
  return first;
}

}  // namespace

hal::Result<std::unique_ptr<BrakeDevices>> open_brake_devices(const BrakeBoard& board,
                                                              const BrakeDeviceOptions& options) {
  auto devices = std::make_unique<Devices>(options);
  FORAGER_TRY(devices->open(board));
  return devices;
}

}  // namespace forager::boards
