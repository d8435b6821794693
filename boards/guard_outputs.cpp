#include "boards/guard_outputs.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "boards/brake_bench.hpp"
#include "boards/brake_devices.hpp"
#include "boards/esc_bench.hpp"
#include "boards/guard_task.hpp"
#include "boards/reader_bench.hpp"
#include "boards/robot_config.hpp"
#include "flight/esc_pulse.hpp"
#include "hal/journal.hpp"
#include "reader/advannet_reader.hpp"

namespace forager::boards {
namespace {

using namespace std::chrono_literals;

constexpr hal::Duration kTries = 1s;
constexpr hal::Duration kPause = 2ms;
constexpr hal::Duration kServoTravels = 2s;      // where pulses end with us
constexpr hal::Duration kAutopilotAnswers = 3s;  // its heartbeats come once a second
constexpr hal::Duration kAutopilotHears = 300ms;
constexpr hal::Duration kReaderAnswers = 3s;

// One brake alone; the other side is a stand-in.
class BrakeTask final : public GuardTask {
 public:
  BrakeTask(BrakeBoard board, bool left, const BrakeDeviceOptions& options)
      : board_(std::move(board)), left_(left), options_(options) {
    (left ? board_.right : board_.left) = {.backend = BrakeBackend::sim};
  }
  hal::Result<> attempt(hal::Instant now) override {
    if (!devices_) {
      auto devices = open_brake_devices(board_, options_);
      if (!devices) return hal::fail(std::move(devices).error());
      devices_ = *std::move(devices);
    }
    return actuator().move(1.0, now);  // from locked, where it is taken to be: no slew
  }
  void live(hal::Instant now) override {
    if (devices_) static_cast<void>(devices_->update(now));
  }
  [[nodiscard]] std::string name() const override {
    std::string text = left_ ? "left brake" : "right brake";
    return devices_ ? text + " (" + std::string(actuator().name()) + ")" : text;
  }
  [[nodiscard]] bool slow() const override { return line().backend == BrakeBackend::modbus; }
  [[nodiscard]] hal::Duration linger() const override {
    return line().backend == BrakeBackend::software_pwm ? kServoTravels : kChipWakes;
  }

 private:
  [[nodiscard]] const BrakeLine& line() const { return left_ ? board_.left : board_.right; }
  [[nodiscard]] servo::BrakeActuator& actuator() const {
    return left_ ? devices_->left() : devices_->right();
  }

  BrakeBoard board_;
  bool left_;
  BrakeDeviceOptions options_;
  std::unique_ptr<BrakeDevices> devices_;
};

// All ESCs of the board: they share a chip.
class EscTask final : public GuardTask {
 public:
  EscTask(const EscBoard& board, const BrakeDeviceOptions& options) : board_(board), options_(options) {}
  hal::Result<> attempt(hal::Instant) override {
    if (!bench_) {
      auto bench =
          open_esc_bench(board_, options_.clock, options_.journal, EscStart::take_over, options_.kernel);
      if (!bench) return hal::fail(std::move(bench).error());
      bench_ = *std::move(bench);
    }
    hal::Result<> first;
    const hal::Duration stop = encode_pulse(board_.bank.pulses.stop, board_.bank.pulses.protocol);
    for (const flight::EscLine& line : bench_->lines())
      if (auto told = line.channel->set_pulse(stop); !told && first) first = std::move(told);
    return first;
  }
  void live(hal::Instant now) override {
    if (bench_) static_cast<void>(bench_->advance(now));
  }
  [[nodiscard]] std::string name() const override { return "ESCs"; }

 private:
  EscBoard board_;
  BrakeDeviceOptions options_;
  std::unique_ptr<EscBench> bench_;
};

void try_all(std::vector<std::unique_ptr<GuardTask>>& tasks, std::vector<SafeOutput>& outcome,
             hal::Clock& clock) {
  const hal::Deadline enough(clock.now(), kTries);
  std::vector<bool> done(tasks.size(), false);
  while (true) {
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      if (done[i]) continue;
      const auto told = tasks[i]->attempt(clock.now());
      done[i] = told.has_value();
      outcome[i] = {tasks[i]->name(), told ? std::nullopt : std::optional(told.error())};
    }
    if (std::all_of(done.begin(), done.end(), [](bool it) { return it; }) || enough.expired(clock.now()))
      return;
    clock.sleep_until(clock.now() + kPause);
  }
}

// Chips that had to be started, pulses that end with us, servos that travel.
void keep_alive(std::vector<std::unique_ptr<GuardTask>>& tasks, hal::Clock& clock) {
  hal::Duration longest{};
  for (const auto& task : tasks) longest = std::max(longest, task->linger());
  for (const hal::Instant end = clock.now() + longest; clock.now() < end;) {
    for (const auto& task : tasks) task->live(clock.now());
    clock.sleep_until(clock.now() + kPause);
  }
}

// Its outputs are asked for over MAVLink, and only once it was heard.
std::vector<SafeOutput> lock_by_autopilot(const Board& board, hal::Clock& clock, hal::Journal& journal) {
  Board asked = board;
  std::vector<SafeOutput> outcome;
  for (const bool left : {true, false}) {
    BrakeLine& line = left ? asked.brakes.left : asked.brakes.right;
    if (line.backend == BrakeBackend::autopilot)
      outcome.push_back({left ? "left brake (autopilot)" : "right brake (autopilot)", std::nullopt});
    else
      line = {.backend = BrakeBackend::sim};
  }
  if (outcome.empty()) return outcome;
  const auto all = [&outcome](const hal::Error& error) {
    for (SafeOutput& output : outcome) output.error = error;
    return outcome;
  };
  const auto bench = open_brake_bench(asked, clock, journal);
  if (!bench) return all(bench.error());
  const auto live_until = [&](hal::Instant end, auto enough) {
    while (clock.now() < end && !enough()) {
      static_cast<void>((*bench)->update(clock.now()));
      clock.sleep_until(clock.now() + kPause);
    }
  };
  live_until(clock.now() + kAutopilotAnswers, [&] { return (*bench)->ready(); });
  if (!(*bench)->ready())
    return all(
        {hal::ErrorCode::timeout, "autopilot", "lock the brakes", "it was not heard within 3 s", "", 0});
  const servo::BrakePair& pair = (*bench)->engage(clock.now());
  live_until(clock.now() + kAutopilotHears, [] { return false; });
  if (pair.state() == servo::BrakeState::faulted)
    return all({hal::ErrorCode::io, "autopilot", "lock the brakes", pair.status().reason, "", 0});
  return outcome;
}

// Its own driver looks for it and stops it; with a plan of which nothing is ever written.
hal::Result<> tell_reader(const Board& board, hal::Clock& clock, hal::Journal& journal) {
  const auto scene = bench_scene();
  if (!scene) return hal::fail(scene.error());
  const auto bench = open_reader_bench(board, *scene, 1);
  if (!bench) return hal::fail(bench.error());
  reader::AdvanNetReader reader((*bench)->rest(), (*bench)->events(), journal, scene->read_plan,
                                advannet_config(*scene, board));
  static_cast<void>(reader.gpo(kLampLine));  // it makes inactive what it was asked for
  const auto live_while = [&](auto going_on) {
    for (const hal::Instant end = clock.now() + kReaderAnswers; going_on() && clock.now() < end;) {
      reader.update(clock.now());
      clock.sleep_until(clock.now() + kPause);
    }
  };
  reader.start(clock.now());
  live_while([&] { return reader.device().id.empty(); });
  const bool found = !reader.device().id.empty();
  reader.stop(clock.now());
  live_while([&] { return !reader.idle(); });
  if (found && !reader.may_radiate()) return {};
  return hal::fail(hal::ErrorCode::timeout, "reader at " + reader_url(board), "stop",
                   found ? "it did not confirm" : "it was not found", "Stop it, or take its power off");
}

bool is_local(BrakeBackend backend) {
  return backend != BrakeBackend::sim && backend != BrakeBackend::autopilot;
}

}  // namespace

bool has_real_outputs(const Board& board, const OutputScope& scope) {
  return (scope.brakes && board.brakes.named && !all_emulated(board.brakes)) ||
         (scope.escs && board.esc.named && board.esc.output != EscOutput::emulated) ||
         (scope.reader && board.kind != BoardKind::sim) ||
         (scope.line && scope.line->chip != "sim" && !scope.line->keep_at_end) ||
         (scope.pulses && scope.pulses->backend != PwmBackend::sim) ||
         (scope.servo && scope.servo->place.backend != PwmBackend::sim);
}

std::vector<SafeOutput> make_outputs_safe(const Board& board, const OutputScope& scope, hal::Clock& clock,
                                          hal::Kernel* kernel) {
  hal::NullJournal journal;
  const BrakeDeviceOptions options{.clock = clock, .journal = journal, .kernel = kernel};
  std::vector<std::unique_ptr<GuardTask>> tasks;
  if (scope.escs && has_real_outputs(board, {.escs = true}))
    tasks.push_back(std::make_unique<EscTask>(board.esc, options));
  if (scope.brakes && board.brakes.named)
    for (const bool left : {true, false})
      if (is_local((left ? board.brakes.left : board.brakes.right).backend))
        tasks.push_back(std::make_unique<BrakeTask>(board.brakes, left, options));
  add_bench_tasks(tasks, scope, journal, kernel);
  std::stable_partition(tasks.begin(), tasks.end(), [](const auto& task) { return !task->slow(); });
  std::vector<SafeOutput> outcome(tasks.size());
  try_all(tasks, outcome, clock);
  keep_alive(tasks, clock);
  if (scope.brakes && board.brakes.named)
    for (SafeOutput& output : lock_by_autopilot(board, clock, journal)) outcome.push_back(std::move(output));
  if (scope.reader && board.kind != BoardKind::sim) {
    const auto told = tell_reader(board, clock, journal);
    outcome.push_back({"reader", told ? std::nullopt : std::optional(told.error())});
  }
  return outcome;
}

}  // namespace forager::boards
