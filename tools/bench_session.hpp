#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "hal/time.hpp"
#include "tools/stop_signal.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

// What the bench commands of single devices share: the loop, the output, the options.
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
  explicit BenchOutput(bool json);
  ~BenchOutput();
  BenchOutput(const BenchOutput&) = delete;
  BenchOutput& operator=(const BenchOutput&) = delete;

  [[nodiscard]] bool json() const { return json_; }
  // Control characters from devices become blanks. With --json nothing.
  void line(std::string_view text);
  // Without --json nothing.
  void record(const nlohmann::ordered_json& object);
  // How things stand right now: repaints one line on a terminal. Elsewhere, and with --json, nothing: there
  // what counts is printed as it changes.
  void live(std::string_view text);
  [[nodiscard]] bool is_live() const { return terminal_ && !json_; }

 private:
  void clear_live();
  bool json_;
  bool terminal_;
  bool live_open_ = false;
};

// "2", "2s", "1.5s", "500ms"; nothing if it is no such time, or not from least to most.
[[nodiscard]] std::optional<hal::Duration> parse_time(std::string_view text, hal::Duration least,
                                                      hal::Duration most);
// "2 s", "500 ms".
[[nodiscard]] std::string time_text(hal::Duration time);

// An option that takes such a time. `into` must live until the command line is parsed.
CLI::Option* add_time_option(CLI::App* app, const std::string& name, std::optional<hal::Duration>& into,
                             const std::string& help, hal::Duration least, hal::Duration most);

}  // namespace forager::tools
