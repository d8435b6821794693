#include "boards/serial_bench.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/scratch_folder.hpp"

namespace forager::boards {
namespace {

namespace fs = std::filesystem;

// A machine with a UART of its own, one that a driver only announces, a USB adapter and a console.
class SerialPortsTest : public testing::Test {
 protected:
  void SetUp() override {
    make("sys/devices/soc/uart0/tty/ttyAMA0", "sys/devices/soc/uart0", "uart-pl011", "4");
    make("sys/devices/platform/serial8250/tty/ttyS1", "sys/devices/platform/serial8250", "serial8250", "0");
    const std::string adapter = "sys/devices/usb1/1-2/1-2:1.0/ttyUSB0";
    make(adapter + "/tty/ttyUSB0", adapter, "ftdi_sio", "");
    put("sys/devices/usb1/1-2/idVendor", "0403\n");
    put("sys/devices/usb1/1-2/product", "FT232R USB UART\n");
    put("sys/devices/usb1/1-2/serial", "A50285BI\n");
    fs::create_directories(path("sys/class/tty/tty0"));
    fs::create_directories(path("dev/serial/by-id"));
    fs::create_symlink("../../ttyUSB0",
                       path("dev/serial/by-id/usb-FTDI_FT232R_USB_UART_A50285BI-if00-port0"));
  }
  [[nodiscard]] fs::path path(const std::string& relative) const { return folder_.file(relative); }
  void put(const std::string& relative, const std::string& text) const {
    fs::create_directories(path(relative).parent_path());
    folder_.write(relative, text);
  }
  void make(const std::string& port, const std::string& device, const std::string& driver,
            const std::string& type) const {
    fs::create_directories(path(port));
    fs::create_directories(path("sys/drivers/" + driver));
    fs::create_directory_symlink(path("sys/drivers/" + driver), path(device + "/driver"));
    fs::create_directory_symlink(path(device), path(port + "/device"));
    if (!type.empty()) put(port + "/type", type + "\n");
    fs::create_directories(path("sys/class/tty"));
    fs::create_directory_symlink(path(port), path("sys/class/tty") / fs::path(port).filename());
  }
  test::ScratchFolder folder_;
};

TEST_F(SerialPortsTest, ListsPortsWithHardwareBehindThem) {
  const auto ports = serial_ports(folder_.path());
  ASSERT_EQ(ports.size(), 2U);
  EXPECT_EQ(ports[0].device, "/dev/ttyAMA0");
  EXPECT_EQ(ports[0].driver, "uart-pl011");
  EXPECT_TRUE(ports[0].by_id.empty());
  EXPECT_EQ(ports[0].product, "");
  EXPECT_EQ(ports[1].device, "/dev/ttyUSB0");
  EXPECT_EQ(ports[1].driver, "ftdi_sio");
  EXPECT_EQ(ports[1].product, "FT232R USB UART");
  EXPECT_EQ(ports[1].serial, "A50285BI");
  EXPECT_THAT(ports[1].by_id,
              testing::ElementsAre("/dev/serial/by-id/usb-FTDI_FT232R_USB_UART_A50285BI-if00-port0"));
}

TEST_F(SerialPortsTest, AMachineWithoutAnyHasAnEmptyList) {
  const test::ScratchFolder bare;
  EXPECT_TRUE(serial_ports(bare.path()).empty());
}

}  // namespace
}  // namespace forager::boards
