#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "hal/digital_out.hpp"
#include "hal/linux/jitter.hpp"
#include "hal/pwm.hpp"
#include "hal/time.hpp"

namespace forager::hal {

class PulseEngine;

// What one line does, said from any thread.
class EngineChannel final : public PwmChannel {
 public:
  EngineChannel(PulseEngine& engine, DigitalOut& line, std::optional<Duration> stale_pulse);

 private:
  friend class PulseEngine;
  Result<> do_set_pulse(Duration length) override;
  Result<> do_release() override;
  [[nodiscard]] std::optional<Duration> do_pulse() const override;
  [[nodiscard]] std::string_view do_name() const override { return name_; }
  [[nodiscard]] Result<> last_fault(std::string_view operation) const;

  static constexpr std::int64_t kReleased = -1;

  PulseEngine* engine_;
  DigitalOut* line_;
  std::string name_;
  std::optional<Duration> stale_pulse_;
  std::atomic<std::int64_t> wanted_ns_{kReleased};
  std::atomic<int> fault_{-1};  // ErrorCode of the last edge; -1: it was made
  // Of the thread that makes the edges alone:
  std::int64_t pulse_ns_ = kReleased;  // of the period that runs
  Instant rose_;
  std::optional<Instant> end_;  // of the pulse that is on; nothing: it lasts into the next period
  bool high_ = false;
};

// Makes pulses on digital lines by waiting for the right moments: software PWM without its thread. Whoever
// calls step() again and again is its clock; channels and period may be told from another thread meanwhile.
//
// All pulses of a period begin together, on a grid that never drifts. A pulse ends its length after its line
// really rose, so a late start makes no short pulse; an end can only come late. A start that is late by more
// than a quarter of the period is left out: nothing is made up for.
//
// Stale: with stale_after, channels that make pulses change to their stale pulse (or to none) when feed()
// was not called for so long. Nothing allocates after construction but the text of a failure.
class PulseEngine : public PwmGroup {
 public:
  static constexpr std::size_t kMost = 16;

  struct Line {
    DigitalOut* line = nullptr;             // borrowed; inactive
    std::optional<Duration> stale_pulse{};  // nothing: released when stale
  };
  PulseEngine(std::string name, const std::vector<Line>& lines, Duration period, Duration stale_after = {});
  ~PulseEngine() override;  // all lines inactive
  PulseEngine(const PulseEngine&) = delete;
  PulseEngine& operator=(const PulseEngine&) = delete;

  [[nodiscard]] EngineChannel& channel(std::size_t index) { return channels_.at(index); }
  [[nodiscard]] std::size_t size() const { return channels_.size(); }

  // Waits for the next edge and makes it, or for the next period if there is none before.
  void step(Clock& clock);
  // Whoever commands the channels lives.
  void feed(Instant now) { fed_ns_.store(now.time_since_epoch().count(), std::memory_order_relaxed); }
  // Every line inactive, at once; for the thread that calls step().
  void all_inactive();

  // How late pulses end: that is what makes them too long.
  [[nodiscard]] const Jitter& pulse_jitter() const { return pulse_jitter_; }
  // How late they begin on the grid.
  [[nodiscard]] const Jitter& start_jitter() const { return start_jitter_; }
  [[nodiscard]] std::uint64_t missed_periods() const { return missed_.load(std::memory_order_relaxed); }

 private:
  friend class EngineChannel;
  Result<> do_set_period(Duration period) override;
  [[nodiscard]] Duration do_period() const override {
    return Duration(period_ns_.load(std::memory_order_relaxed));
  }
  [[nodiscard]] std::string_view do_name() const override { return name_; }

  void begin_period(Clock& clock);
  [[nodiscard]] bool left_out(Instant planned, Instant now);
  void begin_pulse(EngineChannel& channel, Clock& clock);
  void end_pulse(EngineChannel& channel, Clock& clock);
  [[nodiscard]] std::int64_t pulse_for(const EngineChannel& channel, Instant now) const;
  static bool put(EngineChannel& channel, bool active);

  std::string name_;
  std::deque<EngineChannel> channels_;
  std::atomic<std::int64_t> period_ns_;
  Duration stale_after_;
  std::atomic<std::int64_t> fed_ns_{0};
  std::atomic<std::uint64_t> missed_{0};
  std::optional<Instant> next_period_;
  Jitter pulse_jitter_;
  Jitter start_jitter_;
};

}  // namespace forager::hal
