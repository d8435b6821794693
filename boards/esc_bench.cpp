#include "boards/esc_bench.hpp"

#include <deque>
#include <utility>

#include "hal/linux/sysfs_pwm.hpp"
#include "mocks/fake_digital_out.hpp"
#include "mocks/fake_pwm.hpp"
#include "mocks/sim_esc.hpp"

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
  void advance(hal::Instant now) override {
    group_.tick(now);
    power_.tick(now);
    for (mocks::SimEscWire& wire : wires_) wire.update(now);
    for (mocks::SimEsc& esc : escs_) esc.set_power(power_.active(), now);
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

class SysfsBench final : public EscBench {
 public:
  SysfsBench(std::vector<EscMotor> motors, std::unique_ptr<hal::SysfsPwm> pwm)
      : motors_(std::move(motors)), pwm_(std::move(pwm)) {}
  hal::PwmGroup& group() override { return *pwm_; }
  std::vector<flight::EscLine> lines() override {
    std::vector<flight::EscLine> lines;
    for (std::size_t i = 0; i < motors_.size(); ++i) lines.push_back({motors_[i].name, &pwm_->channel(i)});
    return lines;
  }
  hal::DigitalOut* power() override { return nullptr; }
  void advance(hal::Instant) override {}
  std::optional<EscSeen> seen(std::size_t) const override { return std::nullopt; }
  bool emulated() const override { return false; }

 private:
  std::vector<EscMotor> motors_;
  std::unique_ptr<hal::SysfsPwm> pwm_;
};

}  // namespace

hal::Result<std::unique_ptr<EscBench>> open_esc_bench(const EscBoard& board, hal::Clock& clock,
                                                      hal::Journal& journal) {
  if (board.output == EscOutput::emulated) return std::make_unique<SimBench>(board, journal);
  hal::SysfsPwmConfig config;
  config.chip = board.chip;
  config.period = board.period;
  for (const EscMotor& motor : board.motors) config.channels.push_back(motor.channel);
  auto pwm = hal::open_sysfs_pwm(config, clock);
  if (!pwm) return hal::fail(std::move(pwm).error());
  return std::make_unique<SysfsBench>(board.motors, *std::move(pwm));
}

}  // namespace forager::boards
