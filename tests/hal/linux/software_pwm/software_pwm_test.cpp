// The thread of software PWM, on the machine's own clock. How exact it is, is a measurement (forager bench
// jitter), not a test: here it is only right, and free of races.
#include "hal/linux/software_pwm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace forager::hal {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

// What a line does, visible from another thread and after its end.
struct Pin {
  std::atomic<bool> active{false};
  std::atomic<int> rises{0};
  std::atomic<std::int64_t> last_pulse_ns{0};
  std::atomic<bool> gone{false};
};

class PinLine final : public DigitalOut {
 public:
  explicit PinLine(Pin& pin) : pin_(&pin) {}
  ~PinLine() override { pin_->gone = true; }

 private:
  Result<> do_set(bool active) override {
    const auto now = std::chrono::steady_clock::now();
    if (active && !pin_->active) {
      rose_ = now;
      ++pin_->rises;
    }
    if (!active && pin_->active) pin_->last_pulse_ns = (now - rose_).count();
    pin_->active = active;
    return {};
  }
  [[nodiscard]] std::string_view do_name() const override { return "gpio pin"; }
  Pin* pin_;
  std::chrono::steady_clock::time_point rose_;
};

std::vector<SoftwarePwmLine> lines_on(Pin& pin, std::optional<Duration> stale_pulse = std::nullopt) {
  std::vector<SoftwarePwmLine> lines;
  lines.push_back({std::make_unique<PinLine>(pin), stale_pulse});
  return lines;
}

// True as soon as it holds; false if it does not within a time no machine needs.
template <class Condition>
bool soon(Condition condition) {
  for (int i = 0; i < 20000 && !condition(); ++i) std::this_thread::sleep_for(1ms);
  return condition();
}

TEST(SoftwarePwm, MakesPulsesThatAreNeverShort) {
  Pin pin;
  const auto pwm = open_software_pwm(lines_on(pin), {.period = 5ms});
  ASSERT_TRUE(pwm) << describe(pwm.error());
  EXPECT_FALSE(pin.active);
  ASSERT_TRUE((*pwm)->channel(0).set_pulse(1500us));
  ASSERT_TRUE(soon([&] { return pin.rises > 20 && pin.last_pulse_ns > 0; }));
  EXPECT_GE(pin.last_pulse_ns, 1'490'000);  // our stamps are taken a little earlier and later than its own
  EXPECT_GT((*pwm)->pulse_jitter().count(), 0U);
  EXPECT_LE((*pwm)->pulse_jitter().quantile(0.5), (*pwm)->pulse_jitter().max());
}

TEST(SoftwarePwm, ReleasedTheLineRests) {
  Pin pin;
  const auto pwm = open_software_pwm(lines_on(pin), {.period = 2ms});
  ASSERT_TRUE(pwm);
  ASSERT_TRUE((*pwm)->channel(0).set_pulse(1ms));
  ASSERT_TRUE(soon([&] { return pin.rises > 3; }));
  ASSERT_TRUE((*pwm)->channel(0).release());
  ASSERT_TRUE(soon([&] {
    const int before = pin.rises;
    std::this_thread::sleep_for(20ms);
    return pin.rises == before && !pin.active;
  }));
}

TEST(SoftwarePwm, TheEndLeavesTheLineInactiveAndGivesItBack) {
  Pin pin;
  {
    const auto pwm = open_software_pwm(lines_on(pin), {.period = 2ms});
    ASSERT_TRUE(pwm);
    ASSERT_TRUE((*pwm)->channel(0).set_pulse(2ms));  // always on
    ASSERT_TRUE(soon([&] { return pin.active.load(); }));
  }
  EXPECT_FALSE(pin.active);
  EXPECT_TRUE(pin.gone);
}

TEST(SoftwarePwm, WhileItsLoopHangsTheSafePulseIsMade) {
  Pin pin;
  const auto pwm = open_software_pwm(lines_on(pin, 4ms), {.period = 10ms, .stale_after = 50ms});
  ASSERT_TRUE(pwm);
  ASSERT_TRUE((*pwm)->channel(0).set_pulse(1ms));
  EXPECT_TRUE(soon([&] { return pin.last_pulse_ns >= 3'990'000; })) << pin.last_pulse_ns;
  EXPECT_EQ((*pwm)->channel(0).pulse(), 1ms);
}

TEST(SoftwarePwm, EveryThreadMayCommandIt) {
  Pin pin;
  const auto pwm = open_software_pwm(lines_on(pin, 1ms), {.period = 1ms, .stale_after = 10ms});
  ASSERT_TRUE(pwm);
  for (int i = 0; i < 300; ++i) {
    ASSERT_TRUE((*pwm)->channel(0).set_pulse(std::chrono::microseconds(100 + i)));
    (*pwm)->feed();
    ASSERT_TRUE((*pwm)->set_period(std::chrono::milliseconds(1 + i / 50)));
    static_cast<void>((*pwm)->pulse_jitter().quantile(0.99));
    std::this_thread::sleep_for(200us);
  }
}

TEST(SoftwarePwm, SaysHowRealItsTimeIs) {
  Pin pin;
  const auto pwm = open_software_pwm(lines_on(pin), {});
  ASSERT_TRUE(pwm);
  const RealTimeFacts& facts = (*pwm)->facts();
  EXPECT_THAT(facts.text, HasSubstr(facts.real_time ? "SCHED_FIFO 50" : "no real-time priority"));
  EXPECT_THAT(facts.text, HasSubstr(facts.memory_locked ? "memory locked" : "memory not locked"));
}

TEST(SoftwarePwm, RefusesWhatCannotBe) {
  Pin pin;
  const auto code = [](const auto& pwm) { return pwm ? ErrorCode::io : pwm.error().code; };
  EXPECT_EQ(code(open_software_pwm({}, {})), ErrorCode::invalid_argument);
  EXPECT_EQ(code(open_software_pwm(lines_on(pin), {.period = 900us})), ErrorCode::invalid_argument);
  EXPECT_EQ(code(open_software_pwm(lines_on(pin), {.priority = 0})), ErrorCode::invalid_argument);
  EXPECT_EQ(code(open_software_pwm(lines_on(pin, 30ms), {.period = 20ms})), ErrorCode::invalid_argument);
  std::vector<SoftwarePwmLine> none(1);
  EXPECT_EQ(code(open_software_pwm(std::move(none), {})), ErrorCode::invalid_argument);
}

}  // namespace
}  // namespace forager::hal
