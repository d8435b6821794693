#include "tools/cmd_esc.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "boards/board.hpp"
#include "boards/esc_bench.hpp"
#include "boards/output_guard.hpp"
#include "boards/run_clock.hpp"
#include "boards/run_journal.hpp"
#include "flight/motor_authority.hpp"
#include "flight/props_off.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"
#include "tools/esc_output.hpp"
#include "tools/stop_signal.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;

constexpr hal::Duration kTick = 10ms;

// The outermost loop of the bench and what it drives.
class EscSession {
 public:
  EscSession(const EscCommand& command, hal::Clock& clock, boards::EscBench& bench, flight::EscBank& bank,
             boards::OutputGuard& guard, EscOutput& output)
      : command_(command),
        clock_(clock),
        bench_(bench),
        bank_(bank),
        guard_(guard),
        output_(output),
        next_(clock.now()) {}

  int run(const flight::PropsOff& word) {
    if (command_.task == EscTask::calibrate) return calibrate(word);
    wait_for_battery();
    if (auto armed = bank_.arm(word, clock_.now()); !armed) return complain(armed.error());
    while (bank_.state() == flight::EscState::arming && tick()) {
    }
    if (bank_.state() == flight::EscState::armed) hold();
    cut_short_ = bank_.state() != flight::EscState::armed;
    return finish();
  }
  // Stop pulses for so long that every ESC has heard them.
  int stop() {
    while_state(flight::EscState::stopped, 1s);
    return finish();
  }

 private:
  bool tick() {
    if (StopSignal::raised() || trouble_) return false;
    next_ = std::max(next_ + kTick, clock_.now());
    clock_.sleep_until(next_);
    hal::Result<> lives = guard_.feed();
    if (lives) lives = bench_.advance(clock_.now());
    if (lives)
      bank_.update(clock_.now());
    else
      stop_for(lives.error());
    return lives.has_value();
  }
  // Stop pulses, and the time a chip that was made anew takes to send them.
  void stop_for(const hal::Error& error) {
    trouble_ = error;
    bank_.halt();
    for (int i = 0; i < 3; ++i) {
      clock_.sleep_until(clock_.now() + kTick);
      static_cast<void>(bench_.advance(clock_.now()));
    }
  }
  void while_state(flight::EscState state, hal::Duration time) {
    const hal::Instant end = clock_.now() + time;
    while (bank_.state() == state && clock_.now() < end && tick()) {
    }
  }
  void wait_for_battery() {
    if (bench_.power() != nullptr) return;
    output_.tell(clock_.now(),
                 fmt::format("stop pulses are on the lines: connect the ESCs' battery within {} s",
                             command_.connect_s));
    while_state(flight::EscState::stopped, hal::from_seconds(command_.connect_s));
  }
  void hold() {
    std::vector<double> throttle(bank_.size(), 0.0);
    for (std::size_t i = 0; i < bank_.size(); ++i)
      if (command_.motor == "all" || command_.motor == bank_.name(i)) throttle[i] = command_.throttle;
    const hal::Instant end = clock_.now() + hal::from_seconds(command_.hold_s);
    while (bank_.state() == flight::EscState::armed && clock_.now() < end) {
      if (!bank_.command(throttle, clock_.now()) || !tick()) break;
      note_speed(throttle);
    }
  }
  void note_speed(const std::vector<double>& throttle) {
    for (std::size_t i = 0; i < throttle.size(); ++i) {
      const auto seen = bench_.seen(i);
      if (seen && throttle[i] > 0.0 && seen->spin > 0.0) turned_ = true;
    }
  }
  int calibrate(const flight::PropsOff& word) {
    if (auto begun = bank_.calibrate(word, clock_.now()); !begun) return complain(begun.error());
    if (bench_.power() == nullptr)
      output_.tell(clock_.now(), "the lines are high: connect the ESCs' battery now; wait for the beeps");
    while (bank_.state() == flight::EscState::calibrating && tick()) {
    }
    return finish();
  }
  int finish() {
    const bool interrupted = StopSignal::raised();
    const bool faulted = bank_.state() == flight::EscState::faulted;
    std::string why = bank_.reason();
    if (interrupted) output_.tell(clock_.now(), fmt::format("{}: stop pulses", StopSignal::name()));
    bank_.disarm(interrupted ? StopSignal::name() : "done", clock_.now());
    if (const auto lives = bench_.advance(clock_.now()); !lives && !trouble_) trouble_ = lives.error();
    // The last stop is the one that matters.
    const bool unstopped = !faulted && bank_.state() == flight::EscState::faulted;
    if (unstopped) why = bank_.reason();
    output_.end(bank_, bench_, clock_.now());
    if (trouble_) return complain(*trouble_);
    if (unstopped || ((faulted || cut_short_) && !interrupted)) return complain_fault(why);
    return interrupted ? kExitFailure : check();
  }
  static int complain_fault(const std::string& why) {
    fmt::print(stderr, "forager: {}\n", one_line(why));
    return kExitFailure;
  }
  // Real ESCs do not answer; emulated ones can be asked.
  int check() const {
    bool good = command_.task != EscTask::run || command_.throttle == 0.0 || turned_ || !bench_.emulated();
    for (std::size_t i = 0; i < bank_.size(); ++i)
      if (const auto seen = bench_.seen(i); seen && command_.task == EscTask::calibrate)
        good = good && seen->calibrated;
    if (good) return kExitDone;
    fmt::print(stderr, "forager: an emulated ESC has not done what it should\n");
    return kExitCheckFailed;
  }

  const EscCommand& command_;
  hal::Clock& clock_;
  boards::EscBench& bench_;
  flight::EscBank& bank_;
  boards::OutputGuard& guard_;
  EscOutput& output_;
  hal::Instant next_;
  bool turned_ = false;
  bool cut_short_ = false;
  std::optional<hal::Error> trouble_;  // of the chip, or of the guard
};

// What is wrong with the request itself; empty if nothing.
std::string mistake(const EscCommand& command, const boards::EscBoard& board) {
  if (command.task == EscTask::list || command.task == EscTask::stop) return {};
  if (!command.arm) return "nothing turns without --arm: motors will start";
  if (auto word = flight::PropsOff::confirm(command.props_off); !word) return hal::describe(word.error());
  if (command.task == EscTask::calibrate) {
    const bool switched = board.output == boards::EscOutput::emulated;
    return switched || command.battery_off
               ? std::string()
               : "an ESC calibrates only when it gets power: disconnect the ESCs' battery, then say "
                 "--battery-off";
  }
  const auto& motors = board.motors;
  const bool known = command.motor == "all" || std::any_of(motors.begin(), motors.end(), [&](const auto& m) {
                       return m.name == command.motor;
                     });
  if (known) return {};
  std::string names = "all";
  for (const auto& motor : motors) names += ", " + motor.name;
  return fmt::format("there is no motor '{}'. There are: {}", command.motor, names);
}

void add_shared(CLI::App* sub, const std::shared_ptr<EscCommand>& command) {
  sub->add_option("--board", command->board, "Board file with [esc], or sim for emulated ESCs")
      ->capture_default_str();
  sub->add_flag("--json", command->json, "JSON lines on stdout");
}

void add_turning(CLI::App* sub, const std::shared_ptr<EscCommand>& command) {
  add_shared(sub, command);
  sub->add_flag("--arm", command->arm, "Yes, motors may turn");
  sub->add_option("--props-off", command->props_off,
                  fmt::format("Your word, to the letter: \"{}\"", flight::PropsOff::kSentence));
  sub->add_option("--connect-within", command->connect_s,
                  "Seconds for you to connect the ESCs' battery, where it cannot be switched")
      ->capture_default_str()
      ->check(NumberBetween(0.0, 300.0));
  sub->add_flag("--real-time", command->real_time, "Let emulated ESCs live by the clock too");
  sub->add_flag("--pulses", command->pulses, "Print every change of a pulse");
}

void add_run(CLI::App& esc, int& exit_code) {
  auto command = std::make_shared<EscCommand>();
  command->task = EscTask::run;
  CLI::App* sub = esc.add_subcommand("run", "Arm, turn motors for a while, stop");
  add_turning(sub, command);
  sub->add_option("--motor", command->motor, "Name of one motor, or all")->capture_default_str();
  sub->add_option("--throttle", command->throttle, "0 to 1, reached by a ramp")
      ->required()
      ->check(NumberBetween(0.0, 1.0));
  sub->add_option("--hold", command->hold_s, "Seconds, the ramp included; then it stops")
      ->required()
      ->check(NumberBetween(0.01, 600.0));
  sub->callback([command, &exit_code] { exit_code = run_esc_command(*command); });
}

void add_calibrate(CLI::App& esc, int& exit_code) {
  auto command = std::make_shared<EscCommand>();
  command->task = EscTask::calibrate;
  CLI::App* sub = esc.add_subcommand("calibrate", "Teach all ESCs where stop and full are");
  add_turning(sub, command);
  sub->add_flag("--battery-off", command->battery_off, "Your word that the ESCs have no power yet");
  sub->callback([command, &exit_code] { exit_code = run_esc_command(*command); });
}

void add_quiet(CLI::App& esc, const char* name, const char* what, EscTask task, int& exit_code) {
  auto command = std::make_shared<EscCommand>();
  command->task = task;
  CLI::App* sub = esc.add_subcommand(name, what);
  add_shared(sub, command);
  sub->callback([command, &exit_code] { exit_code = run_esc_command(*command); });
}

}  // namespace

int run_esc_command(const EscCommand& command) {
  const auto board = boards::load_board(command.board);
  if (!board) return complain(board.error());
  const boards::EscBoard& lines = board->esc;
  if (!lines.named && command.board != "sim")
    return complain_usage(
        fmt::format("{} has no table [esc]: which lines do the ESCs listen to?", command.board));
  if (const std::string wrong = mistake(command, lines); !wrong.empty()) return complain_usage(wrong);

  EscOutput output(command.json, command.pulses);
  if (command.task == EscTask::list) {
    output.list(lines);
    return kExitDone;
  }
  const auto guard = boards::OutputGuard::start(*board, {.escs = true}, "forager esc");
  if (!guard) return complain(guard.error());
  const bool emulated = lines.output == boards::EscOutput::emulated;
  const auto clock =
      emulated && !command.real_time ? boards::make_virtual_clock() : boards::make_real_clock(1.0);
  const StopSignal signals;
  const auto journal =
      boards::RunJournal::open({}, [&output](hal::Instant now, std::string_view source,
                                             std::string_view text) { output.note(now, source, text); });
  if (!journal) return complain(journal.error());
  const auto bench = boards::open_esc_bench(lines, *clock, **journal);
  if (!bench) return complain(bench.error());

  flight::MotorBay bay;
  auto motors = bay.claim("forager esc");
  if (!motors) return complain(motors.error());
  flight::EscBankConfig config = lines.bank;
  config.calibration.connect = hal::from_seconds(command.connect_s);
  const auto bank = flight::EscBank::create(*std::move(motors), (*bench)->group(), (*bench)->lines(),
                                            (*bench)->power(), **journal, config, clock->now());
  if (!bank) return complain(bank.error());
  if (auto armed = (*guard)->arm(); !armed) return complain(armed.error());
  EscSession session(command, *clock, **bench, **bank, **guard, output);
  if (command.task == EscTask::stop) return session.stop();
  const auto word = flight::PropsOff::confirm(command.props_off);
  return word ? session.run(*word) : complain(word.error());
}

void add_esc_command(CLI::App& app, int& exit_code) {
  CLI::App* esc = app.add_subcommand("esc", "Turn, calibrate and stop motors from the bench, propellers off");
  esc->require_subcommand(1);
  add_quiet(*esc, "list", "Say which ESCs there are and what their pulses mean", EscTask::list, exit_code);
  add_run(*esc, exit_code);
  add_calibrate(*esc, exit_code);
  add_quiet(*esc, "stop", "Send stop pulses to all, and leave them there", EscTask::stop, exit_code);
}

}  // namespace forager::tools
