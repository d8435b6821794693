#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hal/time.hpp"
#include "tools/live_view.hpp"
#include "tools/stop_signal.hpp"

// What the bench commands of single devices share: the loop and the output.
namespace forager::tools {

enum class BenchEnd : std::uint8_t {
  time_over,
  done,      // the step said so
  signalled  // SIGINT, SIGTERM or SIGHUP; Ctrl-C is how a person ends a watch
};

// The outermost loop of a bench command. Catches the signals for as long as it lives, so make it before
// anything is opened that must be left in its safe state.
class BenchLoop {
 public:
  explicit BenchLoop(hal::Clock& clock, hal::Duration tick = std::chrono::milliseconds(10))
      : clock_(&clock), tick_(tick) {}

  // Calls step(now) at once and then every tick until it answers false, a signal comes, or `time` is over
  // (nothing: no limit). The last call comes at the end of the time, not before it.
  BenchEnd run(std::optional<hal::Duration> time, const std::function<bool(hal::Instant now)>& step);

  [[nodiscard]] hal::Instant now() const { return clock_->now(); }
  [[nodiscard]] hal::Clock& clock() const { return *clock_; }

 private:
  StopSignal signals_;
  hal::Clock* clock_;
  hal::Duration tick_;
};

// Results on stdout: lines for people, or with --json one JSON object a line. Every line is out before the
// call returns, so that whoever pipes it can read along.
class BenchOutput {
 public:
  explicit BenchOutput(bool json) : json_(json), view_(!json && LiveView::possible()) {}

  [[nodiscard]] bool json() const { return json_; }
  // With --json nothing.
  void line(const std::string& text);
  // Without --json nothing.
  void record(const nlohmann::ordered_json& object);
  // How things stand right now, written over itself on a terminal. Elsewhere, and with --json, nothing: there
  // what counts is printed as it changes.
  void live(const std::vector<std::string>& block);

 private:
  bool json_;
  LiveView view_;
};

// "2 s", "500 ms".
[[nodiscard]] std::string time_text(hal::Duration time);
// "nothing is driven without --arm: <what>", on stderr; gives kExitUsage.
int complain_not_armed(const std::string& what);
// "<name>: ended by SIGINT before its time", on stderr; gives kExitFailure.
int complain_signalled(const std::string& name);

}  // namespace forager::tools
