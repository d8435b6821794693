#pragma once

#include "hal/pwm.hpp"
#include "mocks/recording_fields.hpp"

namespace forager::mocks {

// PWM outputs; borrow what they record.
//   <pulse = ok 1500000          what it had at the beginning, nanoseconds; no field: released
//   set_pulse 1500000 = ok 1498047      asked and, after the hardware's rounding, got
//   release = ok
//   <period = ok 20000000        at the beginning
//   set_period 3000000 = ok 2949120

class RecordingPwmChannel final : public hal::PwmChannel {
 public:
  RecordingPwmChannel(hal::PwmChannel& channel, hal::Recorder& recorder)
      : channel_(&channel), recorder_(&recorder) {
    recorder.take(name(), "<pulse", {}, now());
  }

 private:
  [[nodiscard]] hal::Fields now() const {
    const auto pulse = channel_->pulse();
    return pulse ? hal::Fields{hal::field(*pulse)} : hal::Fields{};
  }
  hal::Result<> take(std::string_view operation, hal::Fields asked, hal::Result<> answer) {
    recorder_->take(name(), operation, std::move(asked),
                    answer ? hal::Result<hal::Fields>(now()) : hal::fail(answer.error()));
    return answer;
  }
  hal::Result<> do_set_pulse(hal::Duration length) override {
    return take("set_pulse", {hal::field(length)}, channel_->set_pulse(length));
  }
  hal::Result<> do_release() override { return take("release", {}, channel_->release()); }
  [[nodiscard]] std::optional<hal::Duration> do_pulse() const override { return channel_->pulse(); }
  [[nodiscard]] std::string_view do_name() const override { return channel_->name(); }

  hal::PwmChannel* channel_;
  hal::Recorder* recorder_;
};

class RecordingPwmGroup final : public hal::PwmGroup {
 public:
  RecordingPwmGroup(hal::PwmGroup& group, hal::Recorder& recorder) : group_(&group), recorder_(&recorder) {
    recorder.take(name(), "<period", {}, hal::Fields{hal::field(group.period())});
  }

 private:
  hal::Result<> do_set_period(hal::Duration period) override {
    auto answer = group_->set_period(period);
    recorder_->take(name(), "set_period", {hal::field(period)},
                    answer ? hal::Result<hal::Fields>(hal::Fields{hal::field(group_->period())})
                           : hal::fail(answer.error()));
    return answer;
  }
  [[nodiscard]] hal::Duration do_period() const override { return group_->period(); }
  [[nodiscard]] std::string_view do_name() const override { return group_->name(); }

  hal::PwmGroup* group_;
  hal::Recorder* recorder_;
};

}  // namespace forager::mocks
