#include "boards/esc_bench.hpp"

#include <deque>
#include <utility>

#include "hal/linux/i2c_dev.hpp"
#include "hal/linux/kernel.hpp"
#include "hal/linux/sysfs_pwm.hpp"
#include "mocks/fake_digital_out.hpp"
#include "mocks/fake_pwm.hpp"
#include "mocks/sim_esc.hpp"
#include "servo/pca9685.hpp"

namespace forager::boards {
namespace {

double us(hal::Duration d) { return std::chrono::duration<double, std::micro>(d).count(); }

class SimBench final : public EscBench {
 public:
  SimBench(const EscBoard& board, hal::Journal& journal)
      : motors_(board.motors), group_("emulated PWM", motors_.size(), board.period), power_("ESC power") {
    for (std::size_t i = 0; i < motors_.size(); ++i) {
      escs_.emplace_back("emulated " + motors_[i].name, mocks::SimEscParameters{}, &journal);
      wires_.emplace_back(group_.channel(i), group_, escs_.back());
    }
  }
  hal::PwmGroup& group() override { return group_; }
  std::vector<flight::EscLine> lines() override {
    std::vector<flight::EscLine> lines;
    for (std::size_t i = 0; i < motors_.size(); ++i) lines.push_back({motors_[i].name, &group_.channel(i)});
    return lines;
  }
  hal::DigitalOut* power() override { return &power_; }
  hal::Result<> advance(hal::Instant now) override {
    group_.tick(now);
    power_.tick(now);
    for (mocks::SimEscWire& wire : wires_) wire.update(now);
    for (mocks::SimEsc& esc : escs_) esc.set_power(power_.active(), now);
    return {};
  }
  std::optional<EscSeen> seen(std::size_t motor) const override {
    const mocks::SimEsc& esc = escs_[motor];
    return EscSeen{.state = std::string(to_string(esc.state())),
                   .spin = esc.spin(),
                   .stop_us = us(esc.stop_pulse()),
                   .full_us = us(esc.full_pulse()),
                   .calibrated = esc.calibrations_done() > 0};
  }
  bool emulated() const override { return true; }

 private:
  std::vector<EscMotor> motors_;
  mocks::FakePwmGroup group_;
  mocks::FakeDigitalOut power_;
  std::deque<mocks::SimEsc> escs_;
  std::deque<mocks::SimEscWire> wires_;
};

// Lines to channels that are really there.
template <class Chip>
std::vector<flight::EscLine> lines_of(const std::vector<EscMotor>& motors, Chip& chip, auto index_of) {
  std::vector<flight::EscLine> lines;
  for (std::size_t i = 0; i < motors.size(); ++i)
    lines.push_back({motors[i].name, &chip.channel(index_of(i))});
  return lines;
}

// What real ESCs have in common: they do not answer, and a person connects their battery.
class RealBench : public EscBench {
 public:
  hal::DigitalOut* power() override { return nullptr; }
  std::optional<EscSeen> seen(std::size_t) const override { return std::nullopt; }
  bool emulated() const override { return false; }
};

class SysfsBench final : public RealBench {
 public:
  SysfsBench(std::vector<EscMotor> motors, std::unique_ptr<hal::SysfsPwm> pwm)
      : motors_(std::move(motors)), pwm_(std::move(pwm)) {}
  hal::PwmGroup& group() override { return *pwm_; }
  std::vector<flight::EscLine> lines() override {
    return lines_of(motors_, *pwm_, [](std::size_t i) { return i; });
  }
  hal::Result<> advance(hal::Instant) override { return {}; }

 private:
  std::vector<EscMotor> motors_;
  std::unique_ptr<hal::SysfsPwm> pwm_;
};

class Pca9685Bench final : public RealBench {
 public:
  Pca9685Bench(const EscBoard& board, std::unique_ptr<hal::I2c> bus, hal::Journal& journal)
      : motors_(board.motors),
        bus_(std::move(bus)),
        chip_(*bus_, nullptr, journal, {.address = board.address, .period = board.period}) {}
  hal::Result<> open(EscStart start, hal::Instant now) {
    return start == EscStart::take_over ? chip_.adopt(now) : chip_.open(now);
  }
  hal::PwmGroup& group() override { return chip_; }
  std::vector<flight::EscLine> lines() override {
    return lines_of(motors_, chip_, [this](std::size_t i) { return motors_[i].channel; });
  }
  // The chip would come back with the pulses it had, on ESCs that have lost their arming meanwhile.
  hal::Result<> advance(hal::Instant now) override {
    FORAGER_TRY(chip_.update(now));
    if (chip_.recoveries() == recoveries_) return {};
    recoveries_ = chip_.recoveries();
    return hal::fail(hal::ErrorCode::io, std::string(group().name()), "check",
                     "the chip had lost its supply, and the ESCs their pulses",
                     "Check its wiring, then arm anew");
  }

 private:
  std::vector<EscMotor> motors_;
  std::unique_ptr<hal::I2c> bus_;
  servo::Pca9685 chip_;
  std::uint32_t recoveries_ = 0;
};

hal::Result<std::unique_ptr<EscBench>> open_sysfs(const EscBoard& board, hal::Clock& clock,
                                                  hal::Kernel& kernel) {
  hal::SysfsPwmConfig config;
  config.chip = board.chip;
  config.period = board.period;
  for (const EscMotor& motor : board.motors) config.channels.push_back(motor.channel);
  auto pwm = hal::open_sysfs_pwm(config, clock, kernel);
  if (!pwm) return hal::fail(std::move(pwm).error());
  return std::make_unique<SysfsBench>(board.motors, *std::move(pwm));
}

hal::Result<std::unique_ptr<EscBench>> open_pca9685(const EscBoard& board, hal::Clock& clock,
                                                    hal::Journal& journal, EscStart start,
                                                    hal::Kernel& kernel) {
  auto bus = hal::open_i2c_dev({.device = board.bus, .timeout = board.timeout}, kernel);
  if (!bus) return hal::fail(std::move(bus).error());
  auto bench = std::make_unique<Pca9685Bench>(board, *std::move(bus), journal);
  FORAGER_TRY(bench->open(start, clock.now()));
  return bench;
}

}  // namespace

hal::Result<std::unique_ptr<EscBench>> open_esc_bench(const EscBoard& board, hal::Clock& clock,
                                                      hal::Journal& journal, EscStart start,
                                                      hal::Kernel* kernel) {
  hal::Kernel& machine = kernel != nullptr ? *kernel : hal::real_kernel();
  switch (board.output) {
    case EscOutput::sysfs:
      return open_sysfs(board, clock, machine);
    case EscOutput::pca9685:
      return open_pca9685(board, clock, journal, start, machine);
    case EscOutput::emulated:
      break;
  }
  return std::make_unique<SimBench>(board, journal);
}

}  // namespace forager::boards
