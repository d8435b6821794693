#include "tools/run_loop.hpp"

#include <chrono>
#include <exception>
#include <optional>
#include <string>

#include "boards/service_watch.hpp"
#include "tools/stop_signal.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;
using WallClock = std::chrono::steady_clock;

constexpr int kMostFailures = 25;          // updates in a row that throw: half a second
constexpr hal::Duration kToLand = 180s;    // above the mission's own limits for landing and storing
constexpr hal::Duration kStoodStill = 1s;  // after such a stop the loop does not hurry to catch up

class Flight {
 public:
  Flight(boards::Run& run, hal::Clock& clock, RunWatch& watch)
      : run_(run), clock_(clock), watch_(watch), wall_start_(WallClock::now()) {}

  void go() {
    const StopSignal signals;
    const auto service = boards::ServiceWatch::begin();
    for (hal::Instant next = clock_.now(); !run_.done() && !hopeless_; next += boards::Run::kTick) {
      clock_.sleep_until(next);
      const hal::Instant now = clock_.now();
      if (StopSignal::raised() && !halted_at_) {
        watch_.say(std::string(StopSignal::name()) + ": landing; once more ends the program at once");
        halt(now);
      }
      update(now);
      service->alive(now);
      if (halted_at_ && now - *halted_at_ > kToLand) give_up(now);
      if (now > next + kStoodStill) next = now;
    }
    if (!run_.done()) run_.abandon();
  }
  [[nodiscard]] const std::optional<std::string>& fault() const { return fault_; }

 private:
  void update(hal::Instant now) {
    try {
      run_.update(now);
      if (!fault_) watch_.update(run_, now, wall_time_s());
      failures_ = 0;
    } catch (const std::exception& exception) {
      if (!fault_) {
        fault_ = exception.what();
        halt(now);
      }
      if (++failures_ > kMostFailures) give_up(now);
    }
  }
  void halt(hal::Instant now) {
    if (!halted_at_) halted_at_ = now;
    run_.halt();
  }
  // Once there is still the reader to be waited for; twice there is nothing left to do.
  void give_up(hal::Instant now) {
    hopeless_ = abandoned_;
    abandoned_ = true;
    failures_ = 0;
    halted_at_ = now;
    run_.abandon();
  }
  [[nodiscard]] double wall_time_s() const {
    return std::chrono::duration<double>(WallClock::now() - wall_start_).count();
  }

  boards::Run& run_;
  hal::Clock& clock_;
  RunWatch& watch_;
  WallClock::time_point wall_start_;
  std::optional<hal::Instant> halted_at_;
  std::optional<std::string> fault_;
  int failures_ = 0;
  bool abandoned_ = false;
  bool hopeless_ = false;
};

}  // namespace

hal::Result<> run_to_end(boards::Run& run, hal::Clock& clock, RunWatch& watch) {
  Flight flight(run, clock, watch);
  flight.go();
  if (!flight.fault()) return {};
  return hal::fail(hal::ErrorCode::io, "run", "update", *flight.fault(),
                   "The vehicle was asked to land. See the journal for what came before.");
}

}  // namespace forager::tools
