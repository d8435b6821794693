#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/journal.hpp"
#include "hal/pwm.hpp"

namespace forager::mocks {

class FakePwmGroup;

// One channel of a FakePwmGroup.
class FakePwmChannel final : public hal::PwmChannel {
 public:
  struct Change {
    hal::Instant at;
    std::optional<hal::Duration> pulse;  // nothing: released
  };

  FakePwmChannel(FakePwmGroup& group, std::string name) : group_(&group), name_(std::move(name)) {}

  [[nodiscard]] const std::vector<Change>& changes() const { return changes_; }
  [[nodiscard]] std::uint32_t calls() const { return calls_; }  // of set_pulse() and release(), let through
  void fail_next(hal::Error error) { next_error_ = std::move(error); }
  // The cable is out: every call answers disconnected until it is back; the output keeps its pulse.
  void disconnect(bool out = true) { disconnected_ = out; }

 private:
  friend class FakePwmGroup;
  hal::Result<> do_set_pulse(hal::Duration length) override;
  hal::Result<> do_release() override;
  [[nodiscard]] std::optional<hal::Duration> do_pulse() const override { return pulse_; }
  [[nodiscard]] std::string_view do_name() const override { return name_; }
  hal::Result<> admit(std::string_view operation);
  void become(std::optional<hal::Duration> pulse);

  FakePwmGroup* group_;
  std::string name_;
  std::optional<hal::Duration> pulse_;
  bool disconnected_ = false;
  std::uint32_t calls_ = 0;
  std::vector<Change> changes_;
  std::optional<hal::Error> next_error_;
};

// A timer and its channels, exact to the nanosecond, whose pulses a test can look at. With a journal every
// change is noted as "pulse 1500000 ns" or "released", at the time last told by tick().
class FakePwmGroup final : public hal::PwmGroup {
 public:
  explicit FakePwmGroup(std::string name, std::size_t channels,
                        hal::Duration period = std::chrono::milliseconds(20),
                        hal::Journal* journal = nullptr);

  [[nodiscard]] FakePwmChannel& channel(std::size_t index) { return channels_.at(index); }
  void tick(hal::Instant now) { now_ = now; }

 private:
  friend class FakePwmChannel;
  hal::Result<> do_set_period(hal::Duration period) override;
  [[nodiscard]] hal::Duration do_period() const override { return period_; }
  [[nodiscard]] std::string_view do_name() const override { return name_; }

  std::string name_;
  hal::Duration period_;
  hal::Journal* journal_;
  hal::Instant now_;
  std::deque<FakePwmChannel> channels_;
};

}  // namespace forager::mocks
