// The serial backend on the kernel's driver cdc-acm, whose adapter is a gadget of the same kernel.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/linux/serial_port.hpp"
#include "hal/linux/steady_clock.hpp"
#include "tests/hal/byte_stream_contract.hpp"
#include "tests/kernel/serial_gadget.hpp"
#include "tests/kernel/user.hpp"

namespace forager::kernel {
namespace {

using namespace std::chrono_literals;
using hal::ErrorCode;
using hal::StreamState;
using hal::contract::bytes_of;
using hal::contract::eventually;
using hal::contract::read_text;
using testing::HasSubstr;

// Until it is open, or the error that it ends with.
hal::Result<StreamState> opened(hal::ByteStream& port) {
  if (auto begun = port.open(); !begun) return hal::fail(begun.error());
  hal::Result<StreamState> state = StreamState::closed;
  EXPECT_TRUE(eventually([&] {
    state = port.poll();
    return !state || *state == StreamState::open;
  }));
  return state;
}

class SerialOnAKernel : public testing::Test {
 protected:
  // The gadget's end is no line, and knows these settings only.
  static constexpr hal::SerialSettings kGadget{.baud = 9600};
  std::unique_ptr<hal::SerialPort> port(const std::string& device, hal::SerialSettings line = {}) {
    return hal::open_serial_port({.device = device, .line = line}, *clock_);
  }
  SerialGadget gadget_;
  std::unique_ptr<hal::Clock> clock_ = hal::make_steady_clock();
};

TEST_F(SerialOnAKernel, BytesCrossUsbBothWaysAtAnyRate) {
  const auto host = port(gadget_.host_end(), {.baud = 31250, .parity = hal::Parity::even, .stop_bits = 2});
  const auto device = port(gadget_.device_end(), kGadget);
  const auto host_state = opened(*host);
  ASSERT_TRUE(host_state) << describe(host_state.error());
  ASSERT_TRUE(opened(*device));
  EXPECT_EQ(31250U, host->line().baud);
  ASSERT_EQ(4U, host->write(bytes_of("ping")).value());
  EXPECT_EQ("ping", read_text(*device, 4));
  ASSERT_EQ(4U, device->write(bytes_of("pong")).value());
  EXPECT_EQ("pong", read_text(*host, 4));
}

TEST_F(SerialOnAKernel, ARateTheAdapterDoesNotTakeIsNoRateOpened) {
  const auto device = port(gadget_.device_end(), {.baud = 115200});
  const auto refused = opened(*device);
  ASSERT_FALSE(refused);
  EXPECT_EQ(ErrorCode::unsupported, refused.error().code);
  EXPECT_THAT(describe(refused.error()), HasSubstr("9600"));
}

TEST_F(SerialOnAKernel, APortHasOneUserWhoIsNamed) {
  const auto first = port(gadget_.host_end());
  ASSERT_TRUE(opened(*first));
  const auto second = port(gadget_.host_end());
  const auto refused = opened(*second);
  ASSERT_FALSE(refused);
  EXPECT_EQ(ErrorCode::busy, refused.error().code);
  EXPECT_THAT(describe(refused.error()), HasSubstr("/dev/ttyACM0"));
  first->close();
  EXPECT_TRUE(opened(*second));
}

TEST_F(SerialOnAKernel, APulledPlugIsNoticedAndAPortThatComesBackOpens) {
  const auto host = port(gadget_.host_end());
  ASSERT_TRUE(opened(*host));
  gadget_.unplug();
  EXPECT_EQ(ErrorCode::disconnected, hal::contract::code_of_read(*host));
  EXPECT_EQ(StreamState::closed, host->poll().value());
  const auto missing = opened(*host);
  ASSERT_FALSE(missing);
  EXPECT_EQ(ErrorCode::not_present, missing.error().code);
  gadget_.plug_in();
  const auto again = opened(*host);
  ASSERT_TRUE(again) << describe(again.error());
  const auto device = port(gadget_.device_end(), kGadget);
  ASSERT_TRUE(opened(*device));
  ASSERT_EQ(5U, host->write(bytes_of("again")).value());
  EXPECT_EQ("again", read_text(*device, 5));
}

TEST_F(SerialOnAKernel, NobodyMayNotAndTheGroupMay) {
  const auto try_it = [] {
    const auto clock = hal::make_steady_clock();
    const auto port = hal::open_serial_port({.device = SerialGadget::host_end(), .settle = 500ms}, *clock);
    const auto state = opened(*port);
    return state ? std::string("opened")
                 : std::string(to_string(state.error().code)) + ": " + describe(state.error());
  };
  EXPECT_TRUE(eventually([&] { return as_nobody({"dialout"}, try_it) == "opened"; }));
  EXPECT_THAT(as_nobody({}, try_it), testing::AllOf(HasSubstr("permission: "), HasSubstr("group dialout")));
}

// The device's end stays where it is when the plug is pulled; it opens again with it.
class GadgetRig final : public hal::contract::StreamRig {
 public:
  hal::ByteStream& stream() override { return *host_; }
  hal::ByteStream& peer() override { return *device_; }
  void serve() override {
    if (device_->poll().value() == StreamState::closed) (void)device_->open();
    (void)device_->poll();
  }
  void close_peer() override { gadget_.unplug(); }
  void refuse_connects(bool) override {}

 private:
  std::unique_ptr<hal::Clock> clock_ = hal::make_steady_clock();
  SerialGadget gadget_;
  std::unique_ptr<hal::SerialPort> host_ =
      hal::open_serial_port({.device = SerialGadget::host_end()}, *clock_);
  std::unique_ptr<hal::SerialPort> device_ =
      hal::open_serial_port({.device = SerialGadget::device_end(), .line = {.baud = 9600}}, *clock_);
};

}  // namespace
}  // namespace forager::kernel

namespace forager::hal::contract {
INSTANTIATE_TEST_SUITE_P(CdcAcm, ByteStreamContract,
                         testing::Values(RigMaker{"Gadget",
                                                  [] { return std::make_unique<kernel::GadgetRig>(); }}),
                         rig_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(OrderedContract);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ConnectionContract);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(DatagramContract);
}  // namespace forager::hal::contract
