// `forager bench overhead` on lines, a bus and adapters of this kernel. How fast anything is is no business
// of a test; that every device can be measured both ways is.
#include "tools/bench_overhead.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "hal/linux/usb_bus.hpp"
#include "mocks/sim_cdc_acm.hpp"
#include "mocks/sim_i2c_bus.hpp"
#include "mocks/sim_pca9685.hpp"
#include "tests/hal/eventually.hpp"
#include "tests/kernel/gpio_sim.hpp"
#include "tests/kernel/i2c_bridge.hpp"
#include "tests/kernel/usb_plug.hpp"

namespace forager::kernel {
namespace {

// The far end of a serial line: takes everything, and never stops sending.
class Chatter final : public hal::ByteStream {
 private:
  hal::Result<> do_open() override { return {}; }
  hal::Result<hal::StreamState> do_poll() override { return hal::StreamState::open; }
  hal::Result<std::size_t> do_read(std::span<std::byte> into) override {
    std::fill(into.begin(), into.end(), std::byte{'x'});
    return into.size();
  }
  hal::Result<std::size_t> do_write(std::span<const std::byte> bytes) override { return bytes.size(); }
  void do_close() override {}
  [[nodiscard]] std::string_view do_name() const override { return "a chatterbox"; }
};

// Prints the row, as the figures are what a person wants of it.
void expect_measured(const boards::OverheadContest& contest) {
  const auto row = tools::measure_overhead(contest, {.seconds = 1.0});
  ASSERT_TRUE(row) << contest.name << ": " << describe(row.error());
  std::fputs(tools::overhead_json(*row).append("\n").c_str(), stdout);
  EXPECT_TRUE(row->figures.has_value());
}

void expect_measured(const hal::Result<boards::OverheadContest>& contest) {
  ASSERT_TRUE(contest) << describe(contest.error());
  expect_measured(*contest);
}

TEST(OverheadOnAKernel, PinsAreMeasuredBothWaysAndEndInactive) {
  const GpioSim chip("pinctrl-bench", {{"LED"}});
  expect_measured(boards::overhead_gpio("pinctrl-bench/LED"));
  EXPECT_FALSE(chip.level(0));
}

TEST(OverheadOnAKernel, BusesAreMeasuredBothWays) {
  mocks::SimI2cBus wires("wires");
  mocks::SimPca9685 chip;
  wires.attach(0x40, chip);
  const I2cBridge bridge(wires);
  expect_measured(boards::overhead_i2c("7@0x40"));
  expect_measured(boards::overhead_modbus());
}

TEST(OverheadOnAKernel, UsbAdaptersAreMeasuredBothWays) {
  Chatter line;
  mocks::SimCdcAcm adapter(line);
  const UsbPlug plug(adapter);
  const auto usb = hal::open_usb_bus().value();
  const hal::UsbDeviceFacts& facts = adapter.facts();
  ASSERT_TRUE(hal::contract::eventually([&] {
    const auto opened =
        usb->open({.vendor = facts.vendor, .product = facts.product, .serial = {}, .path = {}});
    return opened.has_value();
  }));
  const auto contests = boards::overhead_usb({facts.vendor, facts.product});
  ASSERT_TRUE(contests) << describe(contests.error());
  for (const boards::OverheadContest& contest : *contests) expect_measured(contest);
}

}  // namespace
}  // namespace forager::kernel
