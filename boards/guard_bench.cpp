// What a bench command of single devices left moving.
#include <utility>

#include "boards/bench_devices.hpp"
#include "boards/guard_task.hpp"
#include "servo/servo.hpp"

namespace forager::boards {
namespace {

using namespace std::chrono_literals;

constexpr hal::Duration kReleased = 600ms;  // a servo that is let go at its safe place has got there

// Opened inactive, which tells it already.
class LineTask final : public GuardTask {
 public:
  LineTask(std::unique_ptr<BenchMachine> machine, BenchLine line)
      : machine_(std::move(machine)), line_(std::move(line)) {}
  hal::Result<> attempt(hal::Instant) override {
    if (!out_) {
      auto out = machine_->open_out(line_);
      if (!out) return hal::fail(std::move(out).error());
      out_ = *std::move(out);
    }
    return out_->set(false);
  }
  void live(hal::Instant) override {}
  [[nodiscard]] std::string name() const override { return "gpio " + line_.name; }

 private:
  std::unique_ptr<BenchMachine> machine_;
  BenchLine line_;
  std::unique_ptr<hal::DigitalOut> out_;
};

// The machine's own clock says when a chip is awake.
class PulseTask : public GuardTask {
 public:
  PulseTask(std::unique_ptr<BenchMachine> machine, PwmPlace place)
      : machine_(std::move(machine)), place_(std::move(place)) {}
  hal::Result<> attempt(hal::Instant) override {
    if (!pwm_) {
      auto pwm = machine_->open_pwm(place_, PwmStart::take_over);
      if (!pwm) return hal::fail(std::move(pwm).error());
      pwm_ = *std::move(pwm);
    }
    return tell();
  }
  void live(hal::Instant) override {
    if (pwm_) static_cast<void>(pwm_->update(now()));
  }
  [[nodiscard]] std::string name() const override { return "pwm " + to_string(place_); }

 protected:
  [[nodiscard]] hal::Instant now() const { return machine_->clock().now(); }
  [[nodiscard]] hal::PwmChannel& channel() { return pwm_->channel(); }
  [[nodiscard]] const PwmPlace& place() const { return place_; }

 private:
  virtual hal::Result<> tell() { return channel().release(); }

  std::unique_ptr<BenchMachine> machine_;
  PwmPlace place_;
  std::unique_ptr<BenchPwm> pwm_;
};

class ServoTask final : public PulseTask {
 public:
  ServoTask(std::unique_ptr<BenchMachine> machine, BenchServo wanted)
      : PulseTask(std::move(machine), wanted.place), wanted_(std::move(wanted)) {}
  void live(hal::Instant now_of_guard) override {
    PulseTask::live(now_of_guard);
    if (servo_) static_cast<void>(servo_->move(wanted_.config.safe, now()));
  }
  [[nodiscard]] std::string name() const override {
    return "servo " + wanted_.name + " (" + to_string(place()) + ")";
  }
  [[nodiscard]] hal::Duration linger() const override {
    return wanted_.config.at_halt == servo::AtHalt::release ? kReleased : kChipWakes;
  }

 private:
  hal::Result<> tell() override {
    if (!servo_) {
      auto map = servo::PulseMap::between({0.0, wanted_.from}, {1.0, wanted_.to});
      if (!map) return hal::fail(std::move(map).error());
      auto made = servo::Servo::create(channel(), *std::move(map), wanted_.config);
      if (!made) return hal::fail(std::move(made).error());
      servo_ = std::make_unique<servo::Servo>(*std::move(made));
    }
    auto told = servo_->jump(wanted_.config.safe, now());
    servo_->halt();  // from here on its at_halt counts
    return told;
  }

  BenchServo wanted_;
  std::unique_ptr<servo::Servo> servo_;
};

}  // namespace

void add_bench_tasks(std::vector<std::unique_ptr<GuardTask>>& tasks, const OutputScope& scope,
                     hal::Journal& journal, hal::Kernel* kernel) {
  if (scope.line && has_real_outputs({}, {.line = scope.line}))
    tasks.push_back(std::make_unique<LineTask>(make_real_machine(journal, kernel), *scope.line));
  if (scope.pulses && has_real_outputs({}, {.pulses = scope.pulses}))
    tasks.push_back(std::make_unique<PulseTask>(make_real_machine(journal, kernel), *scope.pulses));
  if (scope.servo && has_real_outputs({}, {.servo = scope.servo}))
    tasks.push_back(std::make_unique<ServoTask>(make_real_machine(journal, kernel), *scope.servo));
}

}  // namespace forager::boards
