#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "hal/digital_out.hpp"
#include "hal/time.hpp"

namespace forager::hal::test {

// Virtual time of a machine that is busy now and then: one sleep can be made to end late.
class LateClock final : public Clock {
 public:
  explicit LateClock(Instant start) : now_(start) {}
  void late_once(Duration by) { late_ = by; }
  void advance(Duration by) { now_ += by; }

 private:
  [[nodiscard]] Instant do_now() const override { return now_; }
  void do_sleep_until(Instant when) override {
    now_ = std::max(now_, when + std::exchange(late_, Duration::zero()));
  }
  Instant now_;
  Duration late_{};
};

// A line with an oscilloscope at its pin.
class StampedLine final : public DigitalOut {
 public:
  StampedLine(std::string name, const Clock& clock) : name_(std::move(name)), clock_(&clock) {}
  [[nodiscard]] bool active() const { return active_; }
  [[nodiscard]] const std::vector<Instant>& rises() const { return rises_; }
  [[nodiscard]] Duration last_pulse() const { return last_pulse_; }
  void unplug(bool out) { unplugged_ = out; }

 private:
  Result<> do_set(bool active) override {
    if (unplugged_) return fail(ErrorCode::disconnected, name_, "set", "the adapter is unplugged");
    if (active && !active_) rises_.push_back(clock_->now());
    if (!active && active_) last_pulse_ = clock_->now() - rises_.back();
    active_ = active;
    return {};
  }
  [[nodiscard]] std::string_view do_name() const override { return name_; }

  std::string name_;
  const Clock* clock_;
  std::vector<Instant> rises_;
  Duration last_pulse_{};
  bool active_ = false;
  bool unplugged_ = false;
};

}  // namespace forager::hal::test
