#include "hal/usb_serial.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/cdc_acm.hpp"
#include "hal/ftdi.hpp"
#include "hal/ftdi_wire.hpp"
#include "mocks/fake_usb.hpp"
#include "mocks/memory_stream.hpp"
#include "mocks/sim_cdc_acm.hpp"
#include "mocks/sim_ftdi.hpp"
#include "mocks/sim_usb_echo.hpp"
#include "tests/hal/eventually.hpp"
#include "tests/hal/usb_serial_rigs.hpp"

namespace forager::hal::contract {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

// What ConnectionContract asks beyond, of a stream whose far end cannot refuse.
class UsbSerialLoss : public testing::TestWithParam<RigMaker> {
 protected:
  void connect() {
    ASSERT_TRUE(stream().open().has_value());
    ASSERT_TRUE(eventually([&] { return stream().poll().value() == StreamState::open; }));
  }
  ByteStream& stream() { return rig_->stream(); }
  std::unique_ptr<StreamRig> rig_ = GetParam().make();
};
INSTANTIATE_TEST_SUITE_P(UsbSerial, UsbSerialLoss, testing::Values(kCdcAcm, kFtdi),
                         [](const auto& rig) { return rig.param.name; });

TEST_P(UsbSerialLoss, LastWordsArriveBeforeTheLossOfTheAdapterIsReported) {
  connect();
  ASSERT_EQ(10U, rig_->peer().write(bytes_of("last words")).value());
  rig_->close_peer();
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(stream().write(bytes_of("more")).has_value());
  EXPECT_EQ("last words", read_text(stream(), 10));
  std::vector<std::byte> room(64);
  Result<std::size_t> gone = std::size_t{0};
  ASSERT_TRUE(eventually([&] { return !(gone = stream().read(room)).has_value(); }));
  EXPECT_EQ(ErrorCode::disconnected, gone.error().code);
  EXPECT_EQ(StreamState::closed, stream().poll().value());
  connect();
  ASSERT_EQ(5U, stream().write(bytes_of("again")).value());
  EXPECT_EQ("again", read_text(rig_->peer(), 5));
}

// One adapter, open, for what only its kind has.
template <class Adapter, class Config>
class Bench {
 public:
  explicit Bench(Config config = {}) : config_(std::move(config)) { usb.plug(adapter); }
  template <class Make>
  auto open(Make make) {
    auto port = make(usb, config_);
    EXPECT_TRUE(port->open().has_value());
    Result<StreamState> state = StreamState::opening;
    for (int i = 0; i < 20 && state && *state == StreamState::opening; ++i) state = port->poll();
    last = state ? Result<>{} : Result<>(fail(state.error()));
    return port;
  }
  mocks::MemoryStreamPair line{"rs232", mocks::MemoryStreamKind::bytes};
  Adapter adapter{line.near()};
  mocks::FakeUsb usb;
  Result<> last;

 private:
  Config config_;
};
using CdcBench = Bench<mocks::SimCdcAcm, UsbSerialConfig>;
using FtdiBench = Bench<mocks::SimFtdi, FtdiConfig>;

SerialSettings settings(std::uint32_t baud) { return {.baud = baud}; }

TEST(CdcAcm, TheLineIsAsAskedAndDtrFollowsThePort) {
  CdcBench bench({.line = {.baud = 57600, .data_bits = 7, .parity = Parity::even, .stop_bits = 2}});
  auto port = bench.open(make_cdc_acm);
  ASSERT_EQ(StreamState::open, port->poll().value());
  EXPECT_EQ("57600 7E2", to_string(bench.adapter.line()));
  EXPECT_EQ("57600 7E2", to_string(port->line()));
  EXPECT_TRUE(bench.adapter.dtr());
  EXPECT_TRUE(bench.adapter.rts());
  port->close();
  EXPECT_FALSE(bench.adapter.dtr());
  EXPECT_EQ("cdc_acm", bench.usb.devices().value()[0].interfaces[1].driver) << "given back to the kernel";
}

TEST(CdcAcm, ARateTheDeviceDoesNotTakeIsAnErrorAndNotGarbage) {
  CdcBench bench({.line = settings(115200)});
  bench.adapter.fix_rate(9600);
  auto port = bench.open(make_cdc_acm);
  ASSERT_FALSE(bench.last.has_value());
  EXPECT_EQ(ErrorCode::unsupported, bench.last.error().code);
  EXPECT_THAT(describe(bench.last.error()), HasSubstr("9600"));
  EXPECT_EQ(StreamState::closed, port->poll().value());
}

TEST(CdcAcm, AnotherDeviceIsNotTakenForOne) {
  mocks::SimUsbEcho echo;
  mocks::FakeUsb usb;
  usb.plug(echo);
  const auto opened = make_cdc_acm(usb, {})->open();
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(ErrorCode::unsupported, opened.error().code);
  usb.unplug(echo);
  EXPECT_EQ(ErrorCode::not_present, make_cdc_acm(usb, {})->open().error().code);
}

TEST(Ftdi, TheLineIsAsAskedAndTheRateIsTheDividersOwn) {
  FtdiBench bench({.usb = {.line = {.baud = 115200,
                                    .data_bits = 8,
                                    .parity = Parity::odd,
                                    .stop_bits = 1,
                                    .flow = FlowControl::hardware}},
                   .latency = 5ms});
  auto port = bench.open(make_ftdi);
  ASSERT_EQ(StreamState::open, port->poll().value());
  EXPECT_EQ("115385 8O1 rts/cts", to_string(bench.adapter.line()));
  EXPECT_EQ("115385 8O1 rts/cts", to_string(port->line()));
  EXPECT_EQ(5, bench.adapter.latency_ms());
  EXPECT_TRUE(bench.adapter.dtr());
  port->close();
  EXPECT_FALSE(bench.adapter.dtr());
  EXPECT_FALSE(bench.adapter.rts());
}

TEST(Ftdi, SettingsTheChipCannotHaveAreNamedBeforeAnythingIsSent) {
  struct Case {
    FtdiConfig config;
    std::string says;
  };
  for (const Case& wrong :
       {Case{{.usb = {.line = settings(2'400'000)}}, "the nearest is 2000000"},
        Case{{.usb = {.line = settings(100)}}, "the nearest is 183"},
        Case{{.usb = {.line = {.data_bits = 6}}}, "7 and 8"}, Case{{.latency = 0ms}, "1 to 255 ms"},
        Case{{.usb = {.port = 1}}, "line 1 of a chip that has 1"}}) {
    mocks::MemoryStreamPair line("rs232", mocks::MemoryStreamKind::bytes);
    mocks::SimFtdi chip(line.near());
    mocks::FakeUsb usb;
    usb.plug(chip);
    const auto opened = make_ftdi(usb, wrong.config)->open();
    ASSERT_FALSE(opened.has_value()) << wrong.says;
    EXPECT_EQ(ErrorCode::invalid_argument, opened.error().code);
    EXPECT_THAT(describe(opened.error()), HasSubstr(wrong.says));
    EXPECT_EQ("ftdi_sio", usb.devices().value()[0].interfaces[0].driver) << "left to the kernel";
  }
}

TEST(Ftdi, AWrongRateAtTheFarEndShowsAsFramingErrorsAndNotAsBytes) {
  FtdiBench bench({.usb = {.line = settings(115200)}});
  auto port = bench.open(make_ftdi);
  bench.adapter.set_far_baud(9600);
  ASSERT_EQ(5U, bench.line.far().write(bytes_of("hello")).value());
  std::vector<std::byte> room(64);
  for (int i = 0; i < 40; ++i) EXPECT_EQ(0U, port->read(room).value());
  EXPECT_EQ(1U, port->errors().framing);
  bench.adapter.set_far_baud(115200);
  ASSERT_EQ(5U, bench.line.far().write(bytes_of("hello")).value());
  EXPECT_EQ("hello", read_text(*port, 5));
}

TEST(Ftdi, AnOverrunIsCountedAndWhatCameIsKept) {
  FtdiBench bench;
  auto port = bench.open(make_ftdi);
  bench.adapter.set_line_status(ftdi::kOverrun);
  ASSERT_EQ(2U, bench.line.far().write(bytes_of("ok")).value());
  EXPECT_EQ("ok", read_text(*port, 2));
  EXPECT_EQ(1U, port->errors().overruns);
}

TEST(SimFtdi, TakesBothModemLinesInOneRequestAndRefusesWhatIsNotDeclared) {
  mocks::MemoryStreamPair line("rs232", mocks::MemoryStreamKind::bytes);
  mocks::SimFtdi chip(line.near());
  const auto ask = [&](std::uint8_t request, std::uint16_t value, std::uint16_t index = 0) {
    return chip.control_out({.request = request, .value = value, .index = index}, {});
  };
  EXPECT_TRUE(ask(ftdi::kSetModemControl, 0x0303));  // as ftdi_sio of Linux does
  EXPECT_TRUE(chip.dtr() && chip.rts());
  EXPECT_TRUE(ask(ftdi::kSetModemControl, ftdi::kRtsLow));
  EXPECT_TRUE(chip.dtr() && !chip.rts());
  EXPECT_FALSE(ask(ftdi::kSetModemControl, 0x0001)) << "no line is meant";
  EXPECT_FALSE(ask(ftdi::kSetModemControl, 0x0404));
  EXPECT_FALSE(ask(ftdi::kSetLatencyTimer, 0));
  EXPECT_FALSE(ask(ftdi::kSetData, 9));
  EXPECT_FALSE(ask(ftdi::kSetBaudRate, 0x4000)) << "an eighth of nothing";
  EXPECT_FALSE(ask(ftdi::kReset, 3));
  EXPECT_FALSE(ask(0x90, 0)) << "its memory is not declared";
}

TEST(Ftdi, AChipOfAnotherKindIsLeftAlone) {
  mocks::MemoryStreamPair line("rs232", mocks::MemoryStreamKind::bytes);
  mocks::SimFtdi old(line.near(), {.release = 0x0200});
  mocks::FakeUsb usb;
  usb.plug(old);
  const auto opened = make_ftdi(usb, {})->open();
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(ErrorCode::unsupported, opened.error().code);
  EXPECT_THAT(describe(opened.error()), HasSubstr("2.00"));
}

TEST(Ftdi, AFastChipHasFastRates) {
  mocks::MemoryStreamPair line("rs232", mocks::MemoryStreamKind::bytes);
  mocks::SimFtdi chip(line.near(), {.product = 0x6014, .release = 0x0900, .packet_bytes = 512});
  mocks::FakeUsb usb;
  usb.plug(chip);
  auto port = make_ftdi(usb, {.usb = {.line = settings(921600)}});
  ASSERT_TRUE(port->open().has_value());
  while (port->poll().value() != StreamState::open) {
  }
  EXPECT_NEAR(921600.0, chip.baud(), 921600 * 0.002);
  ASSERT_EQ(4U, line.far().write(bytes_of("ping")).value());
  EXPECT_EQ("ping", read_text(*port, 4));
}

}  // namespace
}  // namespace forager::hal::contract
