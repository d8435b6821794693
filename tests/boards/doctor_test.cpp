// What the doctor finds on a machine of the test's own making: files, chips and a user.
#include "boards/doctor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "boards/bench_devices.hpp"
#include "mocks/sim_i2c_bus.hpp"
#include "mocks/sim_pca9685.hpp"
#include "mocks/text_journal.hpp"
#include "mocks/virtual_clock.hpp"
#include "tests/hal/linux/fake_i2c_node.hpp"
#include "tests/hal/linux/fake_kernel.hpp"
#include "tests/hal/linux/fake_pwm_chip.hpp"

namespace forager::boards {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class TextFile final : public hal::fake::Node {
 public:
  explicit TextFile(std::string text, int refuse = 0) : text_(std::move(text)), refuse_(refuse) {}
  int open(int) override { return -refuse_; }
  long read(std::string& into) override {
    into = text_;
    return static_cast<long>(into.size());
  }

 private:
  std::string text_;
  int refuse_;
};

class FakeHost final : public DoctorHost {
 public:
  User someone{.name = "pi", .groups = {"gpio", "i2c", "dialout"}};
  std::optional<bool> synchronised = true;
  User user() override { return someone; }
  std::optional<bool> clock_synchronised() override { return synchronised; }
};

PwmPlace channel_of(std::string chip, std::uint32_t channel) {
  PwmPlace place;
  place.chip = std::move(chip);
  place.channel = channel;
  return place;
}
PwmPlace chip_on(std::string bus) {
  PwmPlace place;
  place.backend = PwmBackend::pca9685;
  place.bus = std::move(bus);
  return place;
}

class DoctorTest : public testing::Test {
 protected:
  DoctorTest() {
    file("/proc/sys/kernel/osrelease", "6.1.21-v8+\n");
    file("/sys/kernel/realtime", "1\n");
    file("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance\n");
    file("/sys/devices/system/cpu/cpufreq/boost", "0\n");
    file("/etc/udev/rules.d/99-forager.rules", "");
    wires_.attach(0x40, pca9685_);
    kernel_.files["/dev/i2c-1"] = std::make_shared<hal::fake::FakeI2cNode>(wires_);
  }
  void file(const std::string& path, const std::string& text, int refuse = 0) {
    kernel_.files[path] = std::make_shared<TextFile>(text, refuse);
  }
  Check host(const std::string& name) {
    return only(name, [](const Doctor& doctor) { check_host(doctor); });
  }
  Check board(const std::string& name, const Board& board) {
    return only(name, [&board](const Doctor& doctor) { check_outputs(doctor, board); });
  }
  Check machine(const std::string& name) {
    return only(name, [](const Doctor& doctor) { check_machine(doctor); });
  }
  template <class Checks>
  Check only(const std::string& name, Checks&& checks) {
    std::vector<Check> found;
    const auto machine = make_real_machine(journal_, &kernel_);
    checks(Doctor{kernel_, *machine, host_, [&](const Check& check) {
                    if (check.name == name) found.push_back(check);
                  }});
    EXPECT_EQ(found.size(), 1U) << name;
    return found.empty() ? Check{} : found.front();
  }
  static Board with_servo(PwmPlace place) {
    Board board;
    board.bench.servos.push_back({.name = "tilt", .place = std::move(place), .config = {}});
    return board;
  }

  mocks::VirtualClock clock_;
  hal::fake::FakeKernel kernel_;
  FakeHost host_;
  mocks::TextJournal journal_;
  mocks::SimI2cBus wires_{"wires"};
  mocks::SimPca9685 pca9685_;
};

TEST_F(DoctorTest, AHostAsItShouldBeIsOk) {
  for (const char* name : {"kernel", "real time", "cpu governor", "clock sync", "groups", "udev rules"})
    EXPECT_EQ(host(name).state, CheckState::ok) << name << ": " << host(name).text;
  EXPECT_EQ(host("cpu governor").text, "performance on 1 CPU");
  EXPECT_EQ(host("supply").state, CheckState::skipped);
}

TEST_F(DoctorTest, WhatIsWorseThanItCouldBeIsWarnedOfWithItsMend) {
  file("/proc/sys/kernel/osrelease", "4.9.337-tegra\n");
  file("/sys/kernel/realtime", "0\n");
  file("/sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "ondemand\n");
  kernel_.files.erase("/etc/udev/rules.d/99-forager.rules");
  host_.synchronised = false;
  host_.someone.groups = {"dialout"};
  for (const char* name : {"kernel", "real time", "cpu governor", "clock sync", "groups", "udev rules"}) {
    EXPECT_EQ(host(name).state, CheckState::warned) << name;
    EXPECT_NE(host(name).mend, "") << name;
  }
  EXPECT_THAT(host("cpu governor").text, HasSubstr("ondemand on 1 CPU, performance on 1 CPU"));
  EXPECT_EQ(host("groups").text, "pi is not in gpio,i2c");
  EXPECT_THAT(host("groups").mend, HasSubstr("sudo usermod -aG gpio,i2c pi"));
  file("/proc/sys/kernel/osrelease", "3.18.0\n");
  EXPECT_EQ(host("kernel").state, CheckState::failed);
  host_.synchronised.reset();
  EXPECT_EQ(host("clock sync").state, CheckState::skipped);
}

TEST_F(DoctorTest, ThrottlingNowFailsAndEarlierWarns) {
  file("/proc/device-tree/model", std::string("Raspberry Pi 4 Model B Rev 1.4\0", 31));
  const std::string throttled = "/sys/devices/platform/soc/soc:firmware/get_throttled";
  file(throttled, "0\n");
  EXPECT_EQ(host("supply").state, CheckState::ok);
  file(throttled, "50000\n");
  EXPECT_EQ(host("supply").state, CheckState::warned);
  EXPECT_EQ(host("supply").text, "since the start: under-voltage, throttled");
  file(throttled, "d0008\n");
  EXPECT_EQ(host("supply").state, CheckState::failed);
  EXPECT_EQ(host("supply").text, "right now: too hot");
  kernel_.files.erase(throttled);
  EXPECT_THAT(host("supply").mend, HasSubstr("vcgencmd get_throttled"));
}

TEST_F(DoctorTest, AChipThatIsUnpluggedIsToldFromABusThatIsNotThere) {
  const PwmPlace there = chip_on("/dev/i2c-1");
  EXPECT_EQ(board("servo tilt", with_servo(there)).state, CheckState::ok);
  wires_.detach(0x40);
  const Check unplugged = board("servo tilt", with_servo(there));
  EXPECT_EQ(unplugged.state, CheckState::failed);
  EXPECT_THAT(unplugged.text,
              HasSubstr("no chip answers at 0x40: unplugged, without power, or at another address"));
  EXPECT_THAT(unplugged.mend, HasSubstr("forager i2c scan /dev/i2c-1"));
  const Check no_bus = board("servo tilt", with_servo(chip_on("/dev/i2c-7")));
  EXPECT_THAT(no_bus.text, HasSubstr("there is no such bus"));
  kernel_.files["/dev/i2c-1"] = std::make_shared<TextFile>("", EACCES);
  const Check forbidden = board("servo tilt", with_servo(there));
  EXPECT_THAT(forbidden.text, HasSubstr("the operating system forbids it [Permission denied]"));
  EXPECT_THAT(forbidden.mend, HasSubstr("group i2c"));
}

TEST_F(DoctorTest, PwmChannelsAreLookedUpAndNotTouched) {
  hal::fake::FakePwmChip chip(kernel_, clock_, "pwmchip0", 2);
  kernel_.links["/sys/class/pwm/pwmchip0/device"] = "../../fe20c000.pwm";
  EXPECT_EQ(board("servo tilt", with_servo(channel_of("fe20c000.pwm", 1))).state, CheckState::ok);
  const Check beyond = board("servo tilt", with_servo(channel_of("pwmchip0", 2)));
  EXPECT_EQ(beyond.text, "pwmchip0 has the channels 0 to 1");
  const Check wrong = board("servo tilt", with_servo(channel_of("pwmchip9", 0)));
  EXPECT_EQ(wrong.text, "there is no PWM chip \"pwmchip9\"; there are pwmchip0 (fe20c000.pwm)");
  EXPECT_TRUE(kernel_.writes.empty());
  EXPECT_FALSE(chip.line(1).exported);
  file("/sys/class/pwm/pwmchip0/export", "", EACCES);
  const Check forbidden = board("servo tilt", with_servo(channel_of("pwmchip0", 1)));
  EXPECT_EQ(forbidden.state, CheckState::failed);
  EXPECT_EQ(forbidden.text, "/sys/class/pwm/pwmchip0: the operating system forbids it [Permission denied]");
}

TEST_F(DoctorTest, ADriverOfTheKernelThatHoldsTheUsbBridgeIsNamed) {
  EXPECT_EQ(machine("mcp2221").state, CheckState::skipped);
  file("/sys/bus/hid/devices/0003:04D8:00DD.0001/uevent", "");
  kernel_.links["/sys/bus/hid/devices/0003:04D8:00DD.0001/driver"] = "../../drivers/hid-generic";
  EXPECT_EQ(machine("mcp2221").state, CheckState::ok);
  kernel_.links["/sys/bus/hid/devices/0003:04D8:00DD.0001/driver"] = "../../drivers/mcp2221";
  EXPECT_EQ(machine("mcp2221").state, CheckState::failed);
  EXPECT_THAT(machine("mcp2221").mend, HasSubstr("blacklist hid_mcp2221"));
}

TEST_F(DoctorTest, EveryLibraryIsBuiltInOrNamesItsPackage) {
  std::vector<Check> checks;
  const auto machine = make_real_machine(journal_, &kernel_);
  check_backends(Doctor{kernel_, *machine, host_, [&](const Check& check) { checks.push_back(check); }});
  ASSERT_GE(checks.size(), 8U);
  for (const Check& check : checks) {
    EXPECT_NE(check.state, CheckState::failed);
    if (check.state != CheckState::skipped) continue;
    EXPECT_THAT(check.mend, AllOf(HasSubstr("Install lib"), HasSubstr("-DFORAGER_WITH_"))) << check.name;
  }
}

}  // namespace
}  // namespace forager::boards
