#include "tools/cmd_pwm.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/bench_session.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

double in_us(hal::Duration time) { return static_cast<double>(time.count()) / 1e3; }
hal::Duration from_us(double us) { return hal::from_seconds(us * 1e-6); }

int list_chips(BenchPlace& place, BenchOutput& output) {
  const auto chips = place.machine->pwm_chips();
  if (!chips) return complain(chips.error());
  for (const boards::PwmFacts& chip : *chips) {
    output.record(
        {{"event", "chip"}, {"chip", chip.chip}, {"device", chip.device}, {"channels", chip.channels}});
    output.line(fmt::format("{} ({}): {} channels", chip.chip, chip.device, chip.channels));
    for (const auto& channel : chip.exported) {
      output.record({{"event", "channel"},
                     {"chip", chip.chip},
                     {"channel", channel.channel},
                     {"enabled", channel.enabled},
                     {"pulse_us", in_us(channel.pulse)},
                     {"period_us", in_us(channel.period)}});
      output.line(fmt::format("  {}/{}: {:g} us every {:g} us{}", chip.chip, channel.channel,
                              in_us(channel.pulse), in_us(channel.period), channel.enabled ? "" : ", off"));
    }
  }
  if (chips->empty()) output.line("this machine has no PWM chips");
  for (const boards::BenchServo& servo : place.board.bench.servos) {
    output.record({{"event", "name"}, {"name", servo.name}, {"place", to_string(servo.place)}});
    output.line(fmt::format("{} is {}", servo.name, to_string(servo.place)));
  }
  return kExitDone;
}

// One output that makes pulses, and none any more at the end of its object.
class PulseSession {
 public:
  PulseSession(const PwmCommand& command, BenchPlace& place, boards::OutputGuard& guard, BenchOutput& output)
      : command_(&command),
        machine_(place.machine.get()),
        guard_(&guard),
        output_(&output),
        loop_(machine_->clock()) {}

  int run(const boards::PwmPlace& where) {
    auto opened = machine_->open_pwm(where);
    if (!opened) return complain(opened.error());
    pwm_ = *std::move(opened);
    if (const auto armed = guard_->arm(); !armed) return complain(armed.error());
    name_ = to_string(where);
    const hal::Instant start = loop_.now();
    const bool sweep = command_->task == PwmTask::sweep;
    const hal::Duration one_way = hal::from_seconds(command_->over_s);
    const hal::Duration time = sweep ? 2 * one_way : hal::from_seconds(command_->hold_s);
    tell_start(sweep, time);
    const BenchEnd end = loop_.run(time, [&](hal::Instant now) {
      double pulse_us = command_->pulse_us;
      if (sweep) {
        const double way = hal::to_seconds(now - start) / hal::to_seconds(one_way);
        const double there = 1.0 - std::abs(1.0 - way);  // 0, 1, 0
        pulse_us = command_->from_us + (command_->to_us - command_->from_us) * there;
      }
      return step(from_us(pulse_us), now);
    });
    return finish(end);
  }

 private:
  void tell_start(bool sweep, hal::Duration time) {
    const double period_us = in_us(pwm_->group().period());
    output_->record(
        {{"event", "start"}, {"output", name_}, {"period_us", period_us}, {"hold_s", hal::to_seconds(time)}});
    output_->line(sweep ? fmt::format("{}: {:g} us to {:g} us and back within {}, every {:g} us", name_,
                                      command_->from_us, command_->to_us, time_text(time), period_us)
                        : fmt::format("{}: {:g} us for {}, every {:g} us", name_, command_->pulse_us,
                                      time_text(time), period_us));
  }
  bool step(hal::Duration pulse, hal::Instant now) {
    failed_ = guard_->feed();
    if (failed_) failed_ = pwm_->update(now);
    if (failed_) failed_ = pwm_->channel().set_pulse(pulse);
    if (!failed_) return false;
    const auto made = pwm_->channel().pulse();
    if (made && made != told_) {
      told_ = made;
      output_->record(
          {{"event", "pulse"}, {"t_s", hal::to_seconds(now)}, {"output", name_}, {"pulse_us", in_us(*made)}});
      output_->live({fmt::format("{}: {:.1f} us", name_, in_us(*made))});
    }
    return true;
  }
  int finish(BenchEnd end) {
    const auto released = pwm_->channel().release();
    if (!released) {
      pwm_.reset();
      guard_->hand_over();
    }
    if (!failed_) return complain(failed_.error());
    if (!released) return complain(released.error());
    output_->record({{"event", "end"}, {"output", name_}, {"last_pulse_us", told_ ? in_us(*told_) : 0.0}});
    output_->line(fmt::format("{}: no pulses any more; the last were {:.1f} us long", name_,
                              told_ ? in_us(*told_) : 0.0));
    return end == BenchEnd::signalled ? complain_signalled(name_) : kExitDone;
  }

  const PwmCommand* command_;
  boards::BenchMachine* machine_;
  boards::OutputGuard* guard_;
  BenchOutput* output_;
  BenchLoop loop_;
  std::unique_ptr<boards::BenchPwm> pwm_;
  std::string name_;
  hal::Result<> failed_;
  std::optional<hal::Duration> told_;
};

CLI::App* add_moving(CLI::App& pwm, const char* name, const char* what, PwmTask task,
                     const std::shared_ptr<PwmCommand>& command, int& exit_code) {
  command->task = task;
  CLI::App* sub = pwm.add_subcommand(name, what);
  add_target_options(sub, command->target, true);
  sub->add_option("OUTPUT", command->output,
                  "A servo of the board file, CHIP/CHANNEL (pwmchip0/1), or BUS@ADDRESS/CHANNEL of a PCA9685")
      ->required();
  sub->add_option("--frequency", command->frequency_hz, "Pulses a second; the board file's, or 50")
      ->check(NumberBetween(1.0, 100000.0));
  sub->add_flag("--arm", command->arm, "Yes, what is there may move");
  sub->callback([command, &exit_code] { exit_code = run_pwm_command(*command); });
  return sub;
}

}  // namespace

int run_pwm_command(const PwmCommand& command) {
  if (command.task != PwmTask::list && !command.arm)
    return complain_not_armed(command.task == PwmTask::set
                                  ? fmt::format("{} would make pulses of {:g} us for {:g} s", command.output,
                                                command.pulse_us, command.hold_s)
                                  : fmt::format("{} would make pulses from {:g} us to {:g} us and back",
                                                command.output, command.from_us, command.to_us));
  auto place = open_place(command.target);
  if (!place) return complain(place.error());
  BenchOutput output(command.target.json);
  if (command.task == PwmTask::list) return list_chips(*place, output);
  auto where = boards::find_pwm(place->board.bench, command.output);
  if (!where) return complain(where.error());
  if (command.frequency_hz) where->period = hal::from_seconds(1.0 / *command.frequency_hz);
  const double longest =
      command.task == PwmTask::set ? command.pulse_us : std::max(command.from_us, command.to_us);
  if (from_us(longest) > where->period)
    return complain_usage(
        fmt::format("a pulse of {:g} us is longer than the period, {:g} us", longest, in_us(where->period)));
  const auto guard = guard_output(*place, {.pulses = *where}, "forager pwm");
  if (!guard) return complain(guard.error());
  return PulseSession(command, *place, **guard, output).run(*where);
}

void add_pwm_command(CLI::App& app, int& exit_code) {
  CLI::App* pwm = app.add_subcommand("pwm", "List PWM chips, make pulses on one output");
  pwm->require_subcommand(1);
  auto list = std::make_shared<PwmCommand>();
  CLI::App* sub = pwm->add_subcommand("list", "Chips, channels that are in use, and names of the board file");
  add_target_options(sub, list->target, false);
  sub->callback([list, &exit_code] { exit_code = run_pwm_command(*list); });
  auto set = std::make_shared<PwmCommand>();
  sub = add_moving(*pwm, "set", "Pulses of one length for a while; then none", PwmTask::set, set, exit_code);
  sub->add_option("--us", set->pulse_us, "Length of a pulse in microseconds")
      ->required()
      ->check(NumberBetween(0.0, 1e6));
  sub->add_option("--hold", set->hold_s, "Time, such as 2s or 500ms")
      ->required()
      ->transform(TimeSpan(0.01, 3600.0));
  auto sweep = std::make_shared<PwmCommand>();
  sub = add_moving(*pwm, "sweep", "Pulses from one length to another and back; then none", PwmTask::sweep,
                   sweep, exit_code);
  sub->add_option("--from", sweep->from_us, "Microseconds")
      ->capture_default_str()
      ->check(NumberBetween(0.0, 1e6));
  sub->add_option("--to", sweep->to_us, "Microseconds")
      ->capture_default_str()
      ->check(NumberBetween(0.0, 1e6));
  sub->add_option("--over", sweep->over_s, "Time of one way")
      ->capture_default_str()
      ->transform(TimeSpan(0.05, 600.0));
}

}  // namespace forager::tools
