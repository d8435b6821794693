#include "tests/kernel/serial_gadget.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "tests/hal/eventually.hpp"
#include "tests/kernel/sysfs.hpp"

namespace forager::kernel {
namespace {

namespace fs = std::filesystem;
using hal::contract::eventually;

const std::string kGadget = "/sys/kernel/config/usb_gadget/serial";

void make(const std::string& folder) { ::mkdir((kGadget + folder).c_str(), 0755); }
void remove(const std::string& folder) { ::rmdir((kGadget + folder).c_str()); }

}  // namespace

SerialGadget::SerialGadget() {
  for (const char* folder : {"", "/strings/0x409", "/configs/c.1", "/functions/acm.0"}) make(folder);
  put(kGadget + "/idVendor", "0x1209");
  put(kGadget + "/idProduct", "0x0003");
  put(kGadget + "/strings/0x409/serialnumber", "SN9");
  put(kGadget + "/strings/0x409/product", "Serial gadget");
  EXPECT_EQ(0, ::symlink((kGadget + "/functions/acm.0").c_str(), (kGadget + "/configs/c.1/acm.0").c_str()));
  plug_in();
}

SerialGadget::~SerialGadget() {
  if (plugged_) unplug();
  ::unlink((kGadget + "/configs/c.1/acm.0").c_str());
  for (const char* folder : {"/functions/acm.0", "/configs/c.1", "/strings/0x409", ""}) remove(folder);
}

void SerialGadget::plug_in() {
  std::string controller;
  for (const auto& entry : fs::directory_iterator("/sys/class/udc")) controller = entry.path().filename();
  plugged_ = put(kGadget + "/UDC", controller);
  EXPECT_TRUE(eventually([] { return fs::exists(host_end()); }));
}

void SerialGadget::unplug() {
  put(kGadget + "/UDC", "\n");
  plugged_ = false;
  EXPECT_TRUE(eventually([] { return !fs::exists(host_end()); }));
}

}  // namespace forager::kernel
