#include <gmock/gmock.h>
#include <libusb.h>

#include "hal/ftdi.hpp"
#include "hal/linux/usb_bus.hpp"
#include "mocks/memory_stream.hpp"
#include "mocks/sim_ftdi.hpp"
#include "mocks/sim_usb_echo.hpp"
#include "tests/hal/linux/usb/fake_libusb.hpp"
#include "tests/hal/usb_contract.hpp"

namespace forager::hal::contract {
namespace {

using namespace std::chrono_literals;
using fake::libusb;
using testing::HasSubstr;

class LibusbRig final : public UsbRig {
 public:
  LibusbRig() {
    fake::new_libusb();
    plug();
    usb_ = open_usb_bus({}, libusb().kernel).value();
  }
  Usb& usb() override { return *usb_; }
  void unplug() override { libusb().usb.unplug(echo_); }
  void plug() override {
    libusb().usb.plug(echo_);
    libusb().describe_in_sysfs(echo_.facts());
  }

 private:
  mocks::SimUsbEcho echo_;
  std::unique_ptr<Usb> usb_;
};

INSTANTIATE_TEST_SUITE_P(Libusb, UsbContract,
                         testing::Values(UsbRigMaker{"Libusb", [] { return std::make_unique<LibusbRig>(); }}),
                         [](const auto& rig) { return rig.param.name; });

class LibusbTest : public testing::Test {
 protected:
  LibusbTest() {
    fake::new_libusb();
    libusb().usb.plug(echo_);
    libusb().describe_in_sysfs(echo_.facts());
    usb_ = open_usb_bus({.settle = 500ms}, libusb().kernel).value();
  }
  std::unique_ptr<UsbDevice> open() { return usb_->open({.vendor = 0x1209}).value(); }
  std::unique_ptr<UsbDevice> claimed() {
    auto device = open();
    EXPECT_TRUE(device->claim(0).has_value());
    return device;
  }

  mocks::SimUsbEcho echo_;
  std::unique_ptr<Usb> usb_;
  std::array<std::byte, 64> packet_{};
};

TEST_F(LibusbTest, EverythingIsGivenBackAtTheEnd) {
  EXPECT_EQ("usb by libusb 1.0.26", usb_->name());
  {
    auto device = claimed();
    ASSERT_TRUE(device->start(0x81, {.bytes = 512, .transfers = 8}).has_value());
    EXPECT_EQ(8, libusb().transfers);
  }
  EXPECT_EQ(0, libusb().transfers);
  EXPECT_EQ(0, libusb().open_handles);
  usb_.reset();
  EXPECT_EQ(0, libusb().contexts);
}

TEST_F(LibusbTest, TheKernelsDriverIsDetachedAndAttachedAgain) {
  std::string& driver = libusb().drivers["1-1:0"];
  driver = "cdc_acm";
  auto device = claimed();
  EXPECT_EQ("", driver);
  ASSERT_TRUE(device->release(0).has_value());
  EXPECT_EQ("cdc_acm", driver);
  ASSERT_TRUE(device->claim(0).has_value());
  device.reset();
  EXPECT_EQ("cdc_acm", driver) << "also when nobody released it";
}

TEST_F(LibusbTest, AClaimThatFailsGivesTheDriverBack) {
  libusb().drivers["1-1:0"] = "cdc_acm";
  libusb().fail_claim = LIBUSB_ERROR_BUSY;
  const auto device = open();
  const auto claim = device->claim(0);
  ASSERT_FALSE(claim.has_value());
  EXPECT_EQ(ErrorCode::busy, claim.error().code);
  EXPECT_EQ("cdc_acm", libusb().drivers["1-1:0"]);
}

TEST_F(LibusbTest, TheDriverThatHasAnInterfaceIsNamed) {
  libusb().kernel.links["/sys/bus/usb/devices/1-1:1.0/driver"] = "../../../bus/usb/drivers/ftdi_sio";
  EXPECT_EQ("ftdi_sio", usb_->devices().value()[0].interfaces[0].driver);
  EXPECT_EQ("Bulk echo", usb_->devices().value()[0].product_name);
}

TEST_F(LibusbTest, ANewDeviceIsToldOfOnceUdevHasComeToIt) {
  ASSERT_EQ(1U, usb_->update(Instant(0ms)).value().size());
  libusb().usb.unplug(echo_);
  ASSERT_EQ(1U, usb_->update(Instant(1ms)).value().size());
  libusb().usb.plug(echo_, false);
  for (int ms = 10; ms < 100; ms += 10) EXPECT_TRUE(usb_->update(Instant(ms * 1ms)).value().empty());
  libusb().usb.permit(echo_);
  const auto events = usb_->update(Instant(100ms)).value();
  ASSERT_EQ(1U, events.size());
  EXPECT_TRUE(events[0].arrived);
  EXPECT_TRUE(events[0].permitted);
}

TEST_F(LibusbTest, UdevIsNotWaitedForForEver) {
  static_cast<void>(usb_->update(Instant(0ms)).value());
  libusb().usb.unplug(echo_);
  libusb().usb.plug(echo_, false);
  std::vector<UsbEvent> told;
  Duration at{};
  for (; at <= 700ms; at += 10ms) {
    const auto events = usb_->update(Instant(at)).value();
    std::copy_if(events.begin(), events.end(), std::back_inserter(told),
                 [](const UsbEvent& event) { return event.arrived; });
  }
  ASSERT_EQ(1U, told.size());
  EXPECT_FALSE(told[0].permitted);
  const auto opened = usb_->open({.vendor = 0x1209});
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(ErrorCode::permission, opened.error().code);
  EXPECT_THAT(describe(opened.error()), HasSubstr("99-forager.rules"));
}

TEST_F(LibusbTest, WhoComesAndGoesBetweenTwoUpdatesIsNotToldOf) {
  static_cast<void>(usb_->update(Instant(0ms)).value());
  mocks::SimUsbEcho brief("1-2.4", "BRIEF");
  libusb().usb.plug(brief);
  libusb().usb.unplug(brief);
  EXPECT_TRUE(usb_->update(Instant(1ms)).value().empty());
}

TEST_F(LibusbTest, WithoutUdevThereAreDevicesButNoPlugs) {
  usb_.reset();
  libusb().hotplug = false;
  usb_ = open_usb_bus({}, libusb().kernel).value();
  EXPECT_EQ(1U, usb_->devices().value().size());
  EXPECT_TRUE(usb_->update(Instant(0ms)).value().empty());
}

TEST_F(LibusbTest, EachWayToFailIsAnErrorOfItsOwn) {
  struct Case {
    int libusb_error;
    ErrorCode code;
  };
  const auto device = claimed();
  for (const Case& each :
       {Case{LIBUSB_ERROR_NO_DEVICE, ErrorCode::disconnected}, Case{LIBUSB_ERROR_TIMEOUT, ErrorCode::timeout},
        Case{LIBUSB_ERROR_PIPE, ErrorCode::refused}, Case{LIBUSB_ERROR_OVERFLOW, ErrorCode::protocol},
        Case{LIBUSB_ERROR_IO, ErrorCode::io}, Case{LIBUSB_ERROR_ACCESS, ErrorCode::permission},
        Case{LIBUSB_ERROR_NO_MEM, ErrorCode::io}}) {
    libusb().fail_sync = each.libusb_error;
    const auto read = device->bulk_in(0x81, packet_, 10ms);
    ASSERT_FALSE(read.has_value());
    EXPECT_EQ(each.code, read.error().code);
    EXPECT_THAT(describe(read.error()), HasSubstr("usb 1209:0001 at 1-1: read endpoint 0x81"));
    libusb().fail_sync = each.libusb_error;
    EXPECT_EQ(each.code, device->control_out({.request = 0x43}, {}, 10ms).error().code);
    libusb().fail_sync = each.libusb_error;
    EXPECT_EQ(each.code, device->bulk_out(0x01, packet_, 10ms).error().code);
  }
}

TEST_F(LibusbTest, APipeThatBrokeCanGoOn) {
  struct Case {
    int status;
    ErrorCode code;
  };
  const auto device = claimed();
  ASSERT_TRUE(device->start(0x81, {.bytes = 64, .transfers = 4}).has_value());
  ASSERT_TRUE(device->start(0x01, {.bytes = 64, .transfers = 4}).has_value());
  for (const Case& each :
       {Case{LIBUSB_TRANSFER_STALL, ErrorCode::refused}, Case{LIBUSB_TRANSFER_OVERFLOW, ErrorCode::protocol},
        Case{LIBUSB_TRANSFER_ERROR, ErrorCode::io},
        Case{LIBUSB_TRANSFER_NO_DEVICE, ErrorCode::disconnected}}) {
    libusb().fail_transfer = each.status;
    const auto read = device->poll_in(0x81, packet_);
    ASSERT_FALSE(read.has_value());
    EXPECT_EQ(each.code, read.error().code);
    std::array<std::byte, 3> word{std::byte{1}, std::byte{2}, std::byte{3}};
    ASSERT_EQ(3U, device->push_out(0x01, word).value());
    ASSERT_TRUE(device->drain(0x01, 1s).has_value());
    Result<std::optional<std::size_t>> got = std::nullopt;
    for (int i = 0; i < 10 && got && !*got; ++i) got = device->poll_in(0x81, packet_);
    ASSERT_TRUE(got.has_value());
    EXPECT_EQ(3U, *got);
  }
}

TEST_F(LibusbTest, AFailedWriteShowsAtTheNextOne) {
  const auto device = claimed();
  ASSERT_TRUE(device->start(0x01, {.bytes = 64, .transfers = 2}).has_value());
  ASSERT_EQ(64U, device->push_out(0x01, packet_).value());
  libusb().fail_transfer = LIBUSB_TRANSFER_STALL;
  EXPECT_EQ(ErrorCode::refused, device->push_out(0x01, packet_).error().code);
  EXPECT_EQ(64U, device->push_out(0x01, packet_).value());
}

TEST_F(LibusbTest, ALibraryThatDoesNotStartIsAnError) {
  libusb().fail_init = LIBUSB_ERROR_OTHER;
  const auto opened = open_usb_bus({}, libusb().kernel);
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(ErrorCode::io, opened.error().code);
  EXPECT_THAT(describe(opened.error()), HasSubstr("LIBUSB_ERROR_OF_A_TEST"));
}

TEST_F(LibusbTest, ASerialPortRunsOverIt) {
  mocks::MemoryStreamPair line("rs232", mocks::MemoryStreamKind::bytes);
  mocks::SimFtdi chip(line.near(), {.path = "1-3"});
  libusb().usb.plug(chip);
  libusb().drivers["1-3:0"] = "ftdi_sio";
  const auto port = make_ftdi(*usb_, {.usb = {.device = {.vendor = 0x0403}}});
  ASSERT_TRUE(port->open().has_value());
  ASSERT_TRUE(eventually([&] { return port->poll().value() == StreamState::open; }));
  ASSERT_EQ(4U, port->write(bytes_of("ping")).value());
  ASSERT_TRUE(port->write({}).has_value());
  EXPECT_EQ("ping", read_text(line.far(), 4));
  ASSERT_EQ(4U, line.far().write(bytes_of("pong")).value());
  EXPECT_EQ("pong", read_text(*port, 4));
  port->close();
  EXPECT_EQ("ftdi_sio", libusb().drivers["1-3:0"]);
}

}  // namespace
}  // namespace forager::hal::contract
