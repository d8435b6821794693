#include "hal/linux/serial_port.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "hal/linux/pseudo_terminal.hpp"
#include "mocks/virtual_clock.hpp"
#include "tests/hal/eventually.hpp"
#include "tests/hal/linux/fake_tty.hpp"
#include "tests/scratch_folder.hpp"

namespace forager::hal {
namespace {

using namespace std::chrono_literals;
using contract::bytes_of;
using contract::eventually;
using contract::read_text;
using testing::HasSubstr;

constexpr const char* kPort = "/dev/ttyUSB0";

class SerialPortTest : public testing::Test {
 protected:
  SerialPortTest() { kernel_.files[kPort] = tty_; }
  std::unique_ptr<SerialPort> make(const SerialSettings& line = {}, double tolerance = 0.01) {
    return open_serial_port({.device = kPort, .line = line, .baud_tolerance = tolerance, .settle = 200ms},
                            clock_, kernel_);
  }
  Error error_of_opening(const SerialSettings& line = {}) {
    const auto opened = make(line)->open();
    return opened ? Error{} : opened.error();
  }

  mocks::VirtualClock clock_;
  fake::FakeKernel kernel_;
  std::shared_ptr<fake::FakeTty> tty_ = std::make_shared<fake::FakeTty>();
  std::array<std::byte, 32> room_{};
};

TEST_F(SerialPortTest, SetsRawBytesAtTheAskedRateAndShape) {
  const auto port = make({.baud = 420'000,
                          .data_bits = 7,
                          .parity = Parity::odd,
                          .stop_bits = 2,
                          .flow = FlowControl::hardware});
  ASSERT_TRUE(port->open());
  EXPECT_EQ(StreamState::open, port->poll().value());
  EXPECT_EQ(420'000U, tty_->state.c_ospeed);
  EXPECT_EQ(tcflag_t{BOTHER}, tty_->state.c_cflag & CBAUD);
  EXPECT_EQ(tcflag_t{CS7 | PARENB | PARODD | CSTOPB | CRTSCTS | CREAD | CLOCAL},
            tty_->state.c_cflag & ~tcflag_t{CBAUD});
  EXPECT_EQ(0U, tty_->state.c_lflag | tty_->state.c_oflag);
  EXPECT_EQ(0U, tty_->state.c_iflag & (IXON | IXOFF | ICRNL | INLCR | ISTRIP));
  EXPECT_EQ("420000 7O2 rts/cts", to_string(port->line()));
  EXPECT_EQ(O_NOCTTY | O_NONBLOCK | O_RDWR, tty_->open_flags);
  EXPECT_EQ(TCIOFLUSH, tty_->thrown_away);
}

TEST_F(SerialPortTest, ARateTheAdapterMissesIsRefusedWithWhatItGave) {
  tty_->divider = [](std::uint32_t) { return 9600U; };  // what ftdi_sio falls back to
  const Error error = error_of_opening({.baud = 3'500'000});
  EXPECT_EQ(ErrorCode::unsupported, error.code);
  EXPECT_THAT(describe(error), HasSubstr("asked for 3500000 8N1, the adapter gives 9600 8N1"));
  EXPECT_EQ(0U, kernel_.open_files());
  EXPECT_FALSE(tty_->exclusive);
}

TEST_F(SerialPortTest, ARateWithinTheToleranceIsTakenAndToldAsItIs) {
  tty_->divider = [](std::uint32_t) { return 115'384U; };
  const auto port = make();
  ASSERT_TRUE(port->open());
  EXPECT_EQ(115'384U, port->line().baud);
  port->close();
  EXPECT_EQ(ErrorCode::unsupported, make({}, 0.0)->open().error().code);
}

TEST_F(SerialPortTest, AParityTheAdapterLacksIsNotQuietlyLeftOut) {
  tty_->cannot = PARENB;
  const Error error = error_of_opening({.baud = 19'200, .parity = Parity::even});
  EXPECT_EQ(ErrorCode::unsupported, error.code);
  EXPECT_THAT(describe(error), HasSubstr("asked for 19200 8E1, the adapter gives 19200 8N1"));
}

TEST_F(SerialPortTest, SettingsNoLineCanHaveAreNotTried) {
  EXPECT_EQ(ErrorCode::invalid_argument, error_of_opening({.baud = 0}).code);
  EXPECT_EQ(ErrorCode::invalid_argument, error_of_opening({.data_bits = 9}).code);
  EXPECT_EQ(ErrorCode::invalid_argument, error_of_opening({.stop_bits = 3}).code);
  EXPECT_EQ(ErrorCode::invalid_argument,
            open_serial_port({.device = ""}, clock_, kernel_)->open().error().code);
  EXPECT_EQ(0, tty_->open_flags);
}

TEST_F(SerialPortTest, ABusyPortNamesWhoHasIt) {
  kernel_.links["/dev/serial/by-id/usb-FTDI"] = "../../ttyUSB0";
  kernel_.links["/proc/812/fd/5"] = kPort;
  kernel_.files["/proc/812/fd/5"] = tty_;
  class Comm final : public fake::Node {
    long read(std::string& into) override { return static_cast<long>((into = "ModemManager\n").size()); }
  };
  kernel_.files["/proc/812/comm"] = std::make_shared<Comm>();
  kernel_.files["/dev/serial/by-id/usb-FTDI"] = tty_;
  tty_->locked_by_another = true;
  const auto port = open_serial_port({.device = "/dev/serial/by-id/usb-FTDI"}, clock_, kernel_);
  const Error error = port->open().error();
  EXPECT_EQ(ErrorCode::busy, error.code);
  EXPECT_THAT(describe(error), HasSubstr("open: process 812 (ModemManager) holds the port"));
  EXPECT_EQ(0U, kernel_.open_files());
  tty_->locked_by_another = false;
  tty_->exclusive = true;
  EXPECT_EQ(ErrorCode::busy, error_of_opening().code);
  tty_->exclusive = false;
  EXPECT_TRUE(port->open());
}

TEST_F(SerialPortTest, WaitsForUdevAfterPluggingInButNotForEver) {
  tty_->open_errno = EACCES;
  const auto port = make();
  ASSERT_TRUE(port->open());
  EXPECT_EQ(StreamState::opening, port->poll().value());
  clock_.advance(100ms);
  EXPECT_EQ(StreamState::opening, port->poll().value());
  tty_->open_errno = 0;
  clock_.advance(50ms);
  EXPECT_EQ(StreamState::open, port->poll().value());
  port->close();

  tty_->open_errno = EACCES;
  ASSERT_TRUE(port->open());
  clock_.advance(201ms);
  const auto refused = port->poll();
  ASSERT_FALSE(refused);
  EXPECT_EQ(ErrorCode::permission, refused.error().code);
  EXPECT_THAT(describe(refused.error()),
              testing::AllOf(HasSubstr("group dialout"), HasSubstr("99-forager.rules")));
  EXPECT_EQ(StreamState::closed, port->poll().value());
}

TEST_F(SerialPortTest, UnpluggedAndNeverThereAndNoPortAreThreeThings) {
  const auto port = make();
  ASSERT_TRUE(port->open());
  EXPECT_EQ(0U, port->read(room_).value());  // silence is no error
  tty_->unplugged = true;
  const auto gone = port->read(room_);
  EXPECT_EQ(ErrorCode::disconnected, gone.error().code);
  EXPECT_THAT(describe(gone.error()), HasSubstr("read: the adapter was unplugged"));
  EXPECT_EQ(0U, kernel_.open_files());
  EXPECT_EQ(ErrorCode::not_present, port->open().error().code) << "a node with nothing behind it";
  kernel_.files.erase(kPort);
  EXPECT_THAT(describe(port->open().error()), HasSubstr("ls -l /dev/serial/by-id"));
  class File final : public fake::Node {};
  kernel_.files[kPort] = std::make_shared<File>();
  EXPECT_EQ(ErrorCode::unsupported, port->open().error().code);
  kernel_.files[kPort] = tty_;
  tty_->unplugged = false;
  ASSERT_TRUE(port->open()) << "plugged in again";
  tty_->unplugged = true;
  EXPECT_EQ(ErrorCode::disconnected, port->write(room_).error().code);
}

TEST_F(SerialPortTest, AFullLineTakesNothingAndIsNoFailure) {
  const auto port = make({.flow = FlowControl::hardware});
  ASSERT_TRUE(port->open());
  tty_->full = true;
  EXPECT_EQ(0U, port->write(bytes_of("halt")).value());
  tty_->full = false;
  EXPECT_EQ(4U, port->write(bytes_of("halt")).value());
  port->close();
  EXPECT_EQ(TCOFLUSH, tty_->thrown_away) << "or the close would wait for CTS";
}

TEST(SerialOverPtyTest, TwoCannotHaveOnePort) {
  const test::ScratchFolder folder;
  const auto far = open_pseudo_terminal(folder.file("tty")).value();
  const mocks::VirtualClock clock;
  const auto first = open_serial_port({.device = far->port()}, clock);
  const auto second = open_serial_port({.device = far->port()}, clock);
  ASSERT_TRUE(first->open());
  const auto refused = second->open();
  ASSERT_FALSE(refused);
  EXPECT_EQ(ErrorCode::busy, refused.error().code);
  EXPECT_THAT(describe(refused.error()), HasSubstr("process " + std::to_string(::getpid())));
  first->close();
  EXPECT_TRUE(second->open());
}

TEST(SerialOverPtyTest, EveryByteArrivesAsItIs) {
  const auto far = open_pseudo_terminal().value();
  const mocks::VirtualClock clock;
  const auto port = open_serial_port({.device = far->port(), .line = {.baud = 57'600}}, clock);
  ASSERT_TRUE(port->open());
  ASSERT_TRUE(far->open());
  ASSERT_EQ(StreamState::open, far->poll().value());
  std::string all;
  for (int i = 0; i < 256; ++i) all += static_cast<char>(i);
  ASSERT_EQ(all.size(), port->write(bytes_of(all)).value());
  EXPECT_EQ(all, read_text(*far, all.size()));
  ASSERT_EQ(all.size(), far->write(bytes_of(all)).value());
  EXPECT_EQ(all, read_text(*port, all.size()));
  EXPECT_EQ(57'600U, port->line().baud);
}

TEST(SerialOverPtyTest, ALinkInTheWayIsReplacedAndAFileIsNot) {
  const test::ScratchFolder folder;
  folder.write("file", "dear");
  const auto refused = open_pseudo_terminal(folder.file("file"));
  ASSERT_FALSE(refused);
  EXPECT_EQ(ErrorCode::invalid_argument, refused.error().code);
  EXPECT_EQ("dear", folder.read("file"));
  std::filesystem::create_symlink("/nowhere", folder.file("link"));
  {
    const auto far = open_pseudo_terminal(folder.file("link"));
    ASSERT_TRUE(far) << describe(far.error());
    EXPECT_TRUE(folder.has("link"));
  }
  EXPECT_FALSE(std::filesystem::is_symlink(folder.file("link")));
}

}  // namespace
}  // namespace forager::hal
