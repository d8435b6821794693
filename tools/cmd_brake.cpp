#include "tools/cmd_brake.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <utility>

#include "boards/board.hpp"
#include "boards/brake_bench.hpp"
#include "boards/output_guard.hpp"
#include "boards/run_clock.hpp"
#include "boards/run_journal.hpp"
#include "tools/brake_output.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"
#include "tools/stop_signal.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;

constexpr hal::Duration kTick = 10ms;
constexpr hal::Duration kLocking = 300ms;  // the slowest brake a board file may name needs 250 ms
constexpr hal::Duration kCommandLife = 100ms;

// The outermost loop of the bench.
class BrakeSession {
 public:
  BrakeSession(const BrakeCommandLine& command, hal::Clock& clock, boards::BrakeBench& bench,
               boards::OutputGuard& guard, BrakeOutput& output)
      : command_(command), clock_(clock), bench_(bench), guard_(guard), output_(output), next_(clock.now()) {}

  int run() {
    if (const auto armed = guard_.arm(); !armed) return complain(armed.error());
    pair_ = &bench_.engage(clock_.now());
    if (!bench_.ready()) {
      pair_->halt();  // what is here locks before anything is waited for
      if (!wait_until_ready()) return give_up();
      pair_ = &bench_.engage(clock_.now());
    }
    if (command_.task == BrakeTask::watch)
      tick_for(command_.for_s > 0.0 ? hal::from_seconds(command_.for_s) : hal::Duration::max(), false);
    else
      tick_for(hal::from_seconds(command_.hold_s), true);
    return finish();
  }

 private:
  // False: something must end now.
  bool tick() {
    next_ = std::max(next_ + kTick, clock_.now());
    clock_.sleep_until(next_);
    hal::Result<> updated = bench_.update(clock_.now());
    if (auto fed = guard_.feed(); !fed && updated) updated = std::move(fed);
    if (pair_ != nullptr) output_.state(clock_.now(), *pair_, bench_);
    if (!updated && pair_ != nullptr && !failed_) {
      failed_ = true;
      complain(updated.error());
    }
    return !failed_ && !StopSignal::raised();
  }
  bool wait_until_ready() {
    const hal::Instant end = clock_.now() + hal::from_seconds(command_.connect_s);
    while (!bench_.ready() && clock_.now() < end)
      if (!tick()) return false;
    return bench_.ready();
  }
  // Says the command again and again, so that it runs out when this loop dies.
  void tick_for(hal::Duration time, bool commanding) {
    const hal::Instant start = clock_.now();
    do {
      if (commanding) pair_->command({command_.left, command_.right, clock_.now() + kTick + kCommandLife});
      if (!tick() || pair_->state() == servo::BrakeState::faulted) return;
    } while (clock_.now() - start < time);
  }
  void lock_for_good() {
    pair_->halt();
    for (const hal::Instant end = clock_.now() + kLocking; clock_.now() < end;) static_cast<void>(tick());
  }
  // Waiting came to its end, and what is here is locked.
  int give_up() {
    const bool signalled = StopSignal::raised();
    lock_for_good();
    return signalled || failed_ ? kExitFailure : complain_no_autopilot();
  }
  // Judged after the last lock: it is the one that matters.
  int finish() {
    const bool interrupted = StopSignal::raised();
    const bool faulted = pair_->state() == servo::BrakeState::faulted;
    std::string why = faulted ? pair_->status().reason : std::string();
    lock_for_good();
    output_.state(clock_.now(), *pair_, bench_);
    const servo::BrakeStatus& status = pair_->status();
    if (!faulted && status.left) why = "left brake at the last lock: " + status.left.detail;
    if (!faulted && status.right)
      why += (why.empty() ? "" : "; ") + ("right brake at the last lock: " + status.right.detail);
    if (!why.empty()) fmt::print(stderr, "forager: {}\n", one_line(why));
    if (failed_ || !why.empty()) return kExitFailure;
    return interrupted && command_.task == BrakeTask::set ? kExitFailure : kExitDone;
  }
  [[nodiscard]] int complain_no_autopilot() const {
    return complain({hal::ErrorCode::timeout, "autopilot", "wait for its heartbeat",
                     fmt::format("none came within {:g} s", command_.connect_s),
                     "Check autopilot.address of the board file, its power and the link"});
  }

  const BrakeCommandLine& command_;
  hal::Clock& clock_;
  boards::BrakeBench& bench_;
  boards::OutputGuard& guard_;
  BrakeOutput& output_;
  hal::Instant next_;
  servo::BrakePair* pair_ = nullptr;
  bool failed_ = false;
};

void add_shared(CLI::App* sub, const std::shared_ptr<BrakeCommandLine>& command) {
  sub->add_option("--board", command->board, "Board file with [brakes], or sim for emulated ones")
      ->capture_default_str();
  sub->add_flag("--json", command->json, "JSON lines on stdout");
}

void add_moving(CLI::App* sub, const std::shared_ptr<BrakeCommandLine>& command) {
  add_shared(sub, command);
  sub->add_flag("--arm", command->arm, "Yes, brakes may move");
  sub->add_option("--connect-within", command->connect_s,
                  "Seconds for the autopilot's first heartbeat, where a brake is on one of its outputs")
      ->capture_default_str()
      ->check(NumberBetween(0.1, 300.0));
  sub->add_flag("--real-time", command->real_time, "Let emulated brakes live by the clock too");
}

void add_list(CLI::App& brake, int& exit_code) {
  auto command = std::make_shared<BrakeCommandLine>();
  CLI::App* sub = brake.add_subcommand("list", "Say where both brakes are; moves nothing");
  add_shared(sub, command);
  sub->callback([command, &exit_code] { exit_code = run_brake_command(*command); });
}

void add_set(CLI::App& brake, int& exit_code) {
  auto command = std::make_shared<BrakeCommandLine>();
  command->task = BrakeTask::set;
  CLI::App* sub =
      brake.add_subcommand("set", "Press or open the brakes for a while; then lock both and hold them");
  add_moving(sub, command);
  sub->add_option("--left", command->left, "0 open to 1 locked")
      ->capture_default_str()
      ->check(NumberBetween(0.0, 1.0));
  sub->add_option("--right", command->right, "0 open to 1 locked")
      ->capture_default_str()
      ->check(NumberBetween(0.0, 1.0));
  sub->add_option("--hold", command->hold_s, "Seconds, the way there included; then both lock")
      ->required()
      ->check(NumberBetween(0.01, 600.0));
  sub->callback([command, &exit_code] { exit_code = run_brake_command(*command); });
}

void add_watch(CLI::App& brake, int& exit_code) {
  auto command = std::make_shared<BrakeCommandLine>();
  command->task = BrakeTask::watch;
  CLI::App* sub = brake.add_subcommand(
      "watch", "Lock both, hold them and say what happens, until Ctrl-C; they stay locked");
  add_moving(sub, command);
  sub->add_option("--for", command->for_s, "Stop after so many seconds")->check(NumberBetween(0.01, 1e6));
  sub->callback([command, &exit_code] { exit_code = run_brake_command(*command); });
}

}  // namespace

int run_brake_command(const BrakeCommandLine& command) {
  const auto board = boards::load_board(command.board);
  if (!board) return complain(board.error());
  const boards::BrakeBoard& brakes = board->brakes;
  if (!brakes.named && command.board != "sim")
    return complain_usage(fmt::format("{} has no table [brakes]: where are they?", command.board));
  BrakeOutput output(command.json);
  if (command.task == BrakeTask::list) {
    output.list(brakes);
    return kExitDone;
  }
  if (!command.arm)
    return complain_usage("nothing moves without --arm: both brakes will lock, and go where they are told");
  const auto guard = boards::OutputGuard::start(*board, {.brakes = true}, "forager brake");
  if (!guard) return complain(guard.error());
  const bool jumps = all_emulated(brakes) && !command.real_time;
  if (jumps && command.task == BrakeTask::watch && !(command.for_s > 0.0))
    return complain_usage("emulated brakes are watched with --for, or with --real-time");
  const auto clock = jumps ? boards::make_virtual_clock() : boards::make_real_clock(1.0);
  const StopSignal signals;
  const auto journal =
      boards::RunJournal::open({}, [&output](hal::Instant now, std::string_view source,
                                             std::string_view text) { output.note(now, source, text); });
  if (!journal) return complain(journal.error());
  const auto bench = boards::open_brake_bench(*board, *clock, **journal);
  if (!bench) return complain(bench.error());
  return BrakeSession(command, *clock, **bench, **guard, output).run();
}

void add_brake_command(CLI::App& app, int& exit_code) {
  CLI::App* brake = app.add_subcommand("brake", "Move and watch the brakes from the bench");
  brake->require_subcommand(1);
  add_list(*brake, exit_code);
  add_set(*brake, exit_code);
  add_watch(*brake, exit_code);
}

}  // namespace forager::tools
