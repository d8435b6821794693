// Software PWM on lines of a real kernel: with the rights of a user, and with those of root.
#include "hal/linux/software_pwm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/linux/gpio.hpp"
#include "tests/hal/eventually.hpp"
#include "tests/kernel/gpio_sim.hpp"
#include "tests/kernel/user.hpp"

namespace forager::kernel {
namespace {

using namespace std::chrono_literals;
using hal::contract::eventually;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

// Makes 20 pulses, sees them at the pin, and tells what kind of thread made them.
std::string twenty_pulses(const GpioSim& sim) {
  auto line = hal::open_gpio_out({.chip = "bench", .line = "SERVO"});
  if (!line) return describe(line.error());
  std::vector<hal::SoftwarePwmLine> lines;
  lines.push_back({.line = std::move(line).value()});
  const auto pwm = hal::open_software_pwm(std::move(lines), {});
  if (!pwm) return describe(pwm.error());
  if (const auto set = (*pwm)->channel(0).set_pulse(1500us); !set) return describe(set.error());
  if (!eventually([&] { return sim.level(0); }) || !eventually([&] { return !sim.level(0); }))
    return "a dead pin";
  if (!eventually([&] { return (*pwm)->pulse_jitter().count() >= 20; })) return "no pulses";
  if ((*pwm)->pulse_jitter().max() <= 0ns) return "jitter is not measured";
  return (*pwm)->facts().text;
}

TEST(SoftwarePwmOnAKernel, WithoutTheRightToRealTimeItWorksAndSaysSo) {
  GpioSim sim("bench", {{"SERVO"}});
  std::string said;
  EXPECT_TRUE(eventually([&] {  // once udev has given the chip to the group
    said = as_nobody({"gpio"}, [&] { return twenty_pulses(sim); });
    return said.find("forbids") == std::string::npos;
  }));
  EXPECT_THAT(said, AllOf(StartsWith("no real-time priority (Operation not permitted), memory not locked"),
                          HasSubstr("rtprio 60"), HasSubstr("LimitRTPRIO=60")));
  EXPECT_FALSE(sim.level(0)) << "inactive at its end";
}

TEST(SoftwarePwmOnAKernel, RootHasRealTime) {
  GpioSim sim("bench", {{"SERVO"}});
  EXPECT_EQ("SCHED_FIFO 50, memory locked", in_a_child([&] { return twenty_pulses(sim); }));
}

}  // namespace
}  // namespace forager::kernel
