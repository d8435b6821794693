// The emulated MCP2221A under the kernel's own driver, which leaves no hidraw: its pins and its bus are then
// those of a gpiochip and an i2c adapter, and this program says so. In virtual time, because that driver is
// deaf while it starts and waits 4 s for each answer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "boards/bench_devices.hpp"
#include "boards/doctor.hpp"
#include "hal/journal.hpp"
#include "hal/linux/gpio.hpp"
#include "hal/linux/hid_bus.hpp"
#include "hal/linux/hid_sysfs.hpp"
#include "hal/linux/i2c_dev.hpp"
#include "hal/mcp2221_wire.hpp"
#include "mocks/sim_i2c_bus.hpp"
#include "mocks/sim_mcp2221.hpp"
#include "mocks/sim_pca9685.hpp"
#include "tests/hal/eventually.hpp"
#include "tests/kernel/hid_plug.hpp"
#include "tests/kernel/kernel_module.hpp"
#include "tests/kernel/sysfs.hpp"

namespace forager::kernel {
namespace {

using namespace std::chrono_literals;
using hal::ErrorCode;
using hal::contract::eventually;
using testing::HasSubstr;

class BridgeInVirtualTime : public testing::Test {
 protected:
  BridgeInVirtualTime() {
    wires_.attach(0x41, servo_chip_);
    match_.vendor = hal::mcp2221::kVendor;
    match_.product = hal::mcp2221::kProduct;
  }
  bool opens() { return hid_->open(match_).has_value(); }
  // What `forager doctor` finds out about the bridge.
  static boards::Check diagnosis() {
    boards::Check found;
    hal::NullJournal journal;
    const auto machine = boards::make_real_machine(journal);
    boards::check_machine(
        {hal::real_kernel(), *machine, boards::real_doctor_host(), [&](const boards::Check& check) {
           if (check.name == "mcp2221") found = check;
         }});
    return found;
  }
  // The adapter the kernel made of it; empty: none.
  static std::string adapter() {
    for (const std::string& name : hal::real_kernel().list("/sys/bus/i2c/devices"))
      if (name.starts_with("i2c-") && get("/sys/bus/i2c/devices/" + name + "/name").starts_with("MCP2221"))
        return "/dev/" + name;
    return {};
  }
  static void its_pins_and_its_bus_are_those_of_the_kernel() {
    const auto lines = hal::list_gpio().value();
    EXPECT_EQ(4, std::count_if(lines.begin(), lines.end(),
                               [](const hal::GpioLineFacts& line) { return line.label == "mcp2221_gpio"; }));
    const auto bus = hal::open_i2c_dev({.device = adapter(), .timeout = 2s});
    ASSERT_TRUE(bus) << describe(bus.error());
    ASSERT_TRUE((*bus)->write(0x41, std::array{std::byte{0x00}, std::byte{0x31}}));
    ASSERT_TRUE((*bus)->write(0x41, std::array{std::byte{0x06}, std::byte{0x12}, std::byte{0x03}}));
    std::array<std::byte, 2> two{};
    ASSERT_TRUE((*bus)->write_read(0x41, std::array{std::byte{0x06}}, two));
    EXPECT_EQ((std::array{std::byte{0x12}, std::byte{0x03}}), two);
    const auto absent = (*bus)->read(0x29, two);
    ASSERT_FALSE(absent);
    EXPECT_EQ(ErrorCode::no_ack, absent.error().code) << describe(absent.error());
  }
  mocks::SimI2cBus wires_{"wires"};
  mocks::SimPca9685 servo_chip_;
  mocks::SimMcp2221 chip_{wires_};
  hal::HidMatch match_;
  std::unique_ptr<hal::Hid> hid_ = hal::open_hid_bus().value();
  HidPlug plug_{chip_};
};

TEST_F(BridgeInVirtualTime, TheKernelsDriverKeepsItAndThatIsWhatIsSaid) {
  ASSERT_TRUE(eventually([&] { return opens(); }));
  EXPECT_EQ(boards::CheckState::ok, diagnosis().state) << diagnosis().text;
  {
    const KernelModule driver("hid-mcp2221.ko");
    ASSERT_TRUE(eventually([] { return !adapter().empty(); }));
    const auto refused = hid_->open(match_);
    ASSERT_FALSE(refused);
    EXPECT_EQ(ErrorCode::busy, refused.error().code);
    EXPECT_THAT(describe(refused.error()),
                HasSubstr("the kernel's driver mcp2221 has it and leaves no hidraw"));
    const boards::Check found = diagnosis();
    EXPECT_EQ(boards::CheckState::failed, found.state);
    EXPECT_THAT(found.text, HasSubstr("hid-mcp2221 holds the USB bridge"));
    EXPECT_THAT(found.mend, HasSubstr("blacklist hid_mcp2221"));
    its_pins_and_its_bus_are_those_of_the_kernel();
  }
  EXPECT_TRUE(eventually([&] { return opens(); })) << "as the mend says";
  EXPECT_EQ(boards::CheckState::ok, diagnosis().state) << diagnosis().text;
  const auto held = plug_.lock();
  EXPECT_THAT(chip_.violations(), testing::IsEmpty());
}

}  // namespace
}  // namespace forager::kernel
