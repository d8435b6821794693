#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "flight/esc_bank.hpp"
#include "mocks/fake_digital_out.hpp"
#include "mocks/fake_pwm.hpp"
#include "mocks/sim_esc.hpp"
#include "mocks/text_journal.hpp"

namespace forager::flight {

// A bank, its lines, a power switch and emulated ESCs at the other end, on one time line and one journal.
class EscRig {
 public:
  struct Options {
    hal::Duration period = std::chrono::milliseconds(20);
    std::size_t motors = 1;
    bool switched = true;
    bool powered = false;  // the ESCs have power before the bank exists
    bool note_pulses = false;
    hal::Duration beeps = std::chrono::milliseconds(600);
    EscBankConfig config{.most_throttle = 1.0};
  };

  explicit EscRig(const Options& options) : group_("timer", options.motors, options.period), power_("power") {
    mocks::SimEscParameters parameters;
    parameters.note_pulses = options.note_pulses;
    parameters.beeps = options.beeps;
    std::vector<EscLine> lines;
    for (std::size_t i = 0; i < options.motors; ++i) {
      const std::string name = "motor " + std::to_string(i + 1);
      escs_.push_back(std::make_unique<mocks::SimEsc>("sim " + name, parameters, &journal_));
      wires_.emplace_back(group_.channel(i), group_, *escs_.back());
      lines.push_back({name, &group_.channel(i)});
    }
    if (options.powered) set_power(true);
    auto made = EscBank::create(bay_.claim("bench").value(), group_, std::move(lines),
                                options.switched ? &power_ : nullptr, journal_, options.config, now_);
    if (made) bank_ = std::move(*made);
    switched_ = options.switched;
  }

  // The outside first: it has lived with what was said before.
  void live(hal::Duration step) {
    now_ += step;
    group_.tick(now_);
    power_.tick(now_);
    for (auto& wire : wires_) wire.update(now_);
    if (switched_) set_power(power_.active());
  }
  void step(hal::Duration step = std::chrono::milliseconds(5)) {
    live(step);
    if (bank_) bank_->update(now_);
    if (switched_) set_power(power_.active());
  }
  void run(hal::Duration time) {
    for (const hal::Instant end = now_ + time; now_ < end;) step();
  }
  // Commands the same throttle to all, again and again.
  void fly(double throttle, hal::Duration time) {
    const std::vector<double> all(escs_.size(), throttle);
    for (const hal::Instant end = now_ + time; now_ < end;) {
      (void)bank_->command(all, now_);
      step();
    }
  }
  void arm() {
    ASSERT_TRUE(bank_->arm(word(), now_));
    for (int i = 0; i < 2000 && bank_->state() == EscState::arming; ++i) step();
    ASSERT_EQ(bank_->state(), EscState::armed) << bank_->reason();
  }
  void set_power(bool on) {
    for (auto& esc : escs_) esc->set_power(on, now_);
  }
  [[nodiscard]] static PropsOff word() { return PropsOff::confirm(PropsOff::kSentence).value(); }

  [[nodiscard]] EscBank& bank() { return *bank_; }
  void drop_bank() { bank_.reset(); }
  [[nodiscard]] mocks::SimEsc& esc(std::size_t i = 0) { return *escs_[i]; }
  [[nodiscard]] mocks::FakePwmChannel& channel(std::size_t i = 0) { return group_.channel(i); }
  [[nodiscard]] mocks::FakeDigitalOut& power() { return power_; }
  [[nodiscard]] mocks::TextJournal& journal() { return journal_; }
  [[nodiscard]] MotorBay& bay() { return bay_; }
  [[nodiscard]] hal::Instant now() const { return now_; }
  [[nodiscard]] hal::Duration line(std::size_t i = 0) {
    return group_.channel(i).changes().back().pulse.value_or(hal::Duration::zero());
  }
  // The longest pulse the line has ever carried.
  [[nodiscard]] hal::Duration longest(std::size_t i = 0) {
    hal::Duration most{};
    for (const auto& change : group_.channel(i).changes()) most = std::max(most, change.pulse.value_or(most));
    return most;
  }

 private:
  mocks::TextJournal journal_;
  mocks::FakePwmGroup group_;
  mocks::FakeDigitalOut power_;
  MotorBay bay_;
  std::vector<std::unique_ptr<mocks::SimEsc>> escs_;
  std::vector<mocks::SimEscWire> wires_;
  std::unique_ptr<EscBank> bank_;
  hal::Instant now_{std::chrono::seconds(1)};
  bool switched_ = true;
};

}  // namespace forager::flight
