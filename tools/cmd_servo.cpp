#include "tools/cmd_servo.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "servo/servo.hpp"
#include "tools/bench_session.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;

// After halt(): a chip that still wakes up sends what it was told, a released servo gets its last pulses.
constexpr hal::Duration kEnding = 600ms;

double in_us(hal::Duration time) { return static_cast<double>(time.count()) / 1e3; }

// The emulated machine has one without a board file.
void add_sim_servo(BenchPlace& place) {
  if (!place.machine->emulated()) return;
  boards::BenchServo servo;
  servo.name = "sim";
  servo.place.backend = boards::PwmBackend::sim;
  servo.config.safe = 0.5;
  servo.config.slew_per_s = 2.0;
  place.board.bench.servos.push_back(std::move(servo));
}

int list_servos(const BenchPlace& place, BenchOutput& output) {
  for (const boards::BenchServo& servo : place.board.bench.servos) {
    const bool holds = servo.config.at_halt == servo::AtHalt::hold;
    output.record({{"event", "servo"},
                   {"name", servo.name},
                   {"place", to_string(servo.place)},
                   {"from_us", in_us(servo.from)},
                   {"to_us", in_us(servo.to)},
                   {"trim_us", in_us(servo.config.trim)},
                   {"safe", servo.config.safe},
                   {"at_halt", holds ? "hold" : "release"}});
    output.line(fmt::format("{}: {}, {:g} us to {:g} us, trim {:g} us; safe at {:g}, {}", servo.name,
                            to_string(servo.place), in_us(servo.from), in_us(servo.to),
                            in_us(servo.config.trim), servo.config.safe, holds ? "held" : "released"));
  }
  if (place.board.bench.servos.empty())
    return complain_usage("no servo is named: give a board file with [[servo]], --board FILE");
  return kExitDone;
}

// Moves one servo; at the end of run() it is at its safe place.
class ServoSession {
 public:
  ServoSession(const ServoCommand& command, BenchPlace& place, boards::OutputGuard& guard,
               BenchOutput& output)
      : command_(&command),
        machine_(place.machine.get()),
        guard_(&guard),
        output_(&output),
        loop_(machine_->clock()) {}

  int run(const boards::BenchServo& wanted) {
    name_ = wanted.name;
    auto pwm = machine_->open_pwm(wanted.place);
    if (!pwm) return complain(pwm.error());
    pwm_ = *std::move(pwm);
    if (const auto armed = guard_->arm(); !armed) return complain(armed.error());
    auto map = servo::PulseMap::between({0.0, wanted.from}, {1.0, wanted.to});
    if (!map) return complain(map.error());
    auto made = servo::Servo::create(pwm_->channel(), *std::move(map), wanted.config);
    if (!made) return complain(made.error());
    servo_ = std::make_unique<servo::Servo>(*std::move(made));
    const hal::HaltGuard guard(*servo_);
    return finish(move(), wanted.config);
  }

 private:
  BenchEnd move() {
    const bool sweep = command_->task == ServoTask::sweep;
    const hal::Duration one_way = hal::from_seconds(command_->over_s);
    const hal::Duration time = sweep ? 2 * one_way : hal::from_seconds(command_->hold_s);
    output_->line(sweep ? fmt::format("{}: {:g} to {:g} and back within {}", name_, command_->from,
                                      command_->to, time_text(time))
                        : fmt::format("{}: {:g} for {}", name_, command_->place, time_text(time)));
    const hal::Instant start = loop_.now();
    return loop_.run(time, [&](hal::Instant now) {
      const double way = 1.0 - std::abs(1.0 - hal::to_seconds(now - start) / hal::to_seconds(one_way));
      return step(sweep ? command_->from + (command_->to - command_->from) * way : command_->place, now);
    });
  }
  bool step(double target, hal::Instant now) {
    failed_ = guard_->feed();
    if (failed_) failed_ = pwm_->update(now);
    if (failed_) failed_ = servo_->move(target, now);
    if (failed_) tell(now);
    return failed_.has_value();
  }
  void tell(hal::Instant now) {
    const auto pulse = pwm_->channel().pulse();
    const std::string text = pulse ? fmt::format("{:.1f} us", in_us(*pulse)) : "no pulses";
    output_->live({fmt::format("{}: at {:.3f}, {}", name_, servo_->place(), text)});
    if (text == told_) return;
    told_ = text;
    output_->record({{"event", "state"},
                     {"t_s", hal::to_seconds(now)},
                     {"servo", name_},
                     {"at", servo_->place()},
                     {"pulse_us", pulse ? nlohmann::ordered_json(in_us(*pulse)) : nlohmann::ordered_json()}});
  }
  int finish(BenchEnd end, const servo::ServoConfig& config) {
    const hal::Result<> failed = failed_;
    const std::string signal = StopSignal::name();
    servo_->halt();
    for (const hal::Instant over = loop_.now() + kEnding; loop_.now() < over;) {
      static_cast<void>(step(config.safe, loop_.now()));
      loop_.clock().sleep_until(loop_.now() + 10ms);
    }
    const auto pulse = pwm_->channel().pulse();
    output_->record(
        {{"event", "end"}, {"servo", name_}, {"at", servo_->place()}, {"pulses", pulse.has_value()}});
    output_->line(fmt::format("{}: safe at {:g}, {}", name_, servo_->place(),
                              pulse ? fmt::format("held with {:.1f} us", in_us(*pulse)) : "released"));
    if (!failed) return complain(failed.error());
    if (!failed_) return complain(failed_.error());
    if (command_->task == ServoTask::trim)
      output_->line(fmt::format("to keep it, write into the board file: trim_us = {:g}", command_->trim_us));
    return end == BenchEnd::signalled ? complain_signalled(name_) : kExitDone;
  }

  const ServoCommand* command_;
  boards::BenchMachine* machine_;
  boards::OutputGuard* guard_;
  BenchOutput* output_;
  BenchLoop loop_;
  std::unique_ptr<boards::BenchPwm> pwm_;
  std::unique_ptr<servo::Servo> servo_;
  std::string name_;
  hal::Result<> failed_;
  std::string told_;
};

CLI::App* add_moving(CLI::App& servo, const char* name, const char* what, ServoTask task,
                     const std::shared_ptr<ServoCommand>& command, int& exit_code) {
  command->task = task;
  CLI::App* sub = servo.add_subcommand(name, what);
  add_target_options(sub, command->target, true);
  sub->add_option("SERVO", command->servo,
                  "Name of the board file; brakes that are servos are brakes.left and brakes.right")
      ->required();
  sub->add_flag("--arm", command->arm, "Yes, it may move");
  sub->callback([command, &exit_code] { exit_code = run_servo_command(*command); });
  return sub;
}

void add_hold(CLI::App* sub, ServoCommand& command) {
  sub->add_option("--hold", command.hold_s,
                  "Time, the way there included, such as 2s; then it goes to its safe place")
      ->required()
      ->transform(TimeSpan(0.01, 3600.0));
}

std::string what_moves(const ServoCommand& command) {
  return command.task == ServoTask::sweep
             ? fmt::format("{} would go from {:g} to {:g} and back", command.servo, command.from, command.to)
             : fmt::format("{} would go to {:g} for {:g} s", command.servo, command.place, command.hold_s);
}

}  // namespace

int run_servo_command(const ServoCommand& command) {
  if (command.task != ServoTask::list && !command.arm) return complain_not_armed(what_moves(command));
  auto place = open_place(command.target);
  if (!place) return complain(place.error());
  add_sim_servo(*place);
  BenchOutput output(command.target.json);
  if (command.task == ServoTask::list) return list_servos(*place, output);
  auto servo = boards::find_servo(place->board.bench, command.servo);
  if (!servo) return complain(servo.error());
  if (command.task == ServoTask::trim) servo->config.trim = hal::from_seconds(command.trim_us * 1e-6);
  const auto guard = guard_output(*place, {.servo = *servo}, "forager servo");
  if (!guard) return complain(guard.error());
  return ServoSession(command, *place, **guard, output).run(*servo);
}

void add_servo_command(CLI::App& app, int& exit_code) {
  CLI::App* servo = app.add_subcommand("servo", "Move a servo of the board file, find its trim");
  servo->require_subcommand(1);
  auto list = std::make_shared<ServoCommand>();
  CLI::App* sub = servo->add_subcommand("list", "Servos of the board file; moves nothing");
  add_target_options(sub, list->target, false);
  sub->callback([list, &exit_code] { exit_code = run_servo_command(*list); });
  auto set = std::make_shared<ServoCommand>();
  sub = add_moving(*servo, "set", "Go to a place for a while, then to the safe place", ServoTask::set, set,
                   exit_code);
  sub->add_option("PLACE", set->place, "0 to 1 of the travel")->required()->check(NumberBetween(0.0, 1.0));
  add_hold(sub, *set);
  auto sweep = std::make_shared<ServoCommand>();
  sub = add_moving(*servo, "sweep", "Go from one place to another and back", ServoTask::sweep, sweep,
                   exit_code);
  sub->add_option("--from", sweep->from, "0 to 1")->capture_default_str()->check(NumberBetween(0.0, 1.0));
  sub->add_option("--to", sweep->to, "0 to 1")->capture_default_str()->check(NumberBetween(0.0, 1.0));
  sub->add_option("--over", sweep->over_s, "Time of one way")
      ->capture_default_str()
      ->transform(TimeSpan(0.05, 600.0));
  auto trim = std::make_shared<ServoCommand>();
  sub =
      add_moving(*servo, "trim", "Try a trim instead of the board file's", ServoTask::trim, trim, exit_code);
  sub->add_option("--us", trim->trim_us, "Microseconds added to every pulse")
      ->required()
      ->check(NumberBetween(-500.0, 500.0));
  sub->add_option("--at", trim->place, "Where to look at it, 0 to 1")
      ->capture_default_str()
      ->check(NumberBetween(0.0, 1.0));
  add_hold(sub, *trim);
}

}  // namespace forager::tools
