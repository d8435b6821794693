// hidapi over hidraw. Twin: absent_hidapi_bus.cpp.
#include <fcntl.h>
#include <fmt/format.h>
#include <hidapi.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>

#include "hal/linux/hid_bus.hpp"
#include "hal/linux/hid_sysfs.hpp"
#include "hal/linux/hidapi_device.hpp"

namespace forager::hal {
namespace {

std::string utf8(const wchar_t* text) {
  std::string bytes;
  for (; text != nullptr && *text != L'\0'; ++text) {
    const auto code = std::bit_cast<std::uint32_t>(*text);  // of Linux: 32 bits, signed or not
    const auto tail = [&](unsigned shift) { bytes += static_cast<char>(0x80U | (code >> shift & 0x3FU)); };
    if (code < 0x80U) {
      bytes += static_cast<char>(code);
    } else if (code < 0x800U) {
      bytes += static_cast<char>(0xC0U | code >> 6U);
      tail(0);
    } else {  // descriptors of USB hold 16 bits a letter
      bytes += static_cast<char>(0xE0U | (code >> 12U & 0x0FU));
      tail(6);
      tail(0);
    }
  }
  return bytes;
}

class HidapiBus final : public Hid {
 public:
  explicit HidapiBus(Kernel& kernel) : kernel_(&kernel), name_("hid by " + hid_library()) {}
  ~HidapiBus() override { hid_exit(); }
  HidapiBus(const HidapiBus&) = delete;
  HidapiBus& operator=(const HidapiBus&) = delete;

 private:
  Result<std::vector<HidDeviceFacts>> do_devices() override;
  Result<std::unique_ptr<HidDevice>> do_open(const HidDeviceFacts& device, HidSharing sharing) override;
  [[nodiscard]] std::string_view do_name() const override { return name_; }

  Kernel* kernel_;
  std::string name_;
};

Result<std::vector<HidDeviceFacts>> HidapiBus::do_devices() {
  std::vector<HidDeviceFacts> devices;
  hid_device_info* const all = hid_enumerate(0, 0);
  for (const hid_device_info* each = all; each != nullptr; each = each->next) {
    // One entry for every collection of a device: the first says what it is.
    if (!devices.empty() && devices.back().path == each->path) continue;
    devices.push_back({.vendor = each->vendor_id,
                       .product = each->product_id,
                       .serial = utf8(each->serial_number),
                       .manufacturer = utf8(each->manufacturer_string),
                       .product_name = utf8(each->product_string),
                       .path = each->path,
                       .usage_page = each->usage_page,
                       .usage = each->usage,
                       .interface_number = each->interface_number,
                       .driver = {}});
  }
  hid_free_enumeration(all);
  for (HidNode& node : list_hid_nodes(*kernel_)) {
    const auto known = std::find_if(devices.begin(), devices.end(), [&](const HidDeviceFacts& device) {
      return !node.facts.path.empty() && device.path == node.facts.path;
    });
    if (known != devices.end())
      known->driver = node.facts.driver;
    else if (node.facts.path.empty() && !node.facts.driver.empty())
      devices.push_back(std::move(node.facts));
  }
  return devices;
}

Result<std::unique_ptr<HidDevice>> HidapiBus::do_open(const HidDeviceFacts& device, HidSharing sharing) {
  // hidapi does not hand on why an open failed.
  const int probe = kernel_->open(device.path, O_RDWR | O_NONBLOCK);
  if (probe < 0) return hid_open_failure(describe(device), -probe);
  kernel_->close(probe);
  std::vector<int> grabs;
  if (sharing == HidSharing::exclusive) {
    auto grabbed = grab_inputs(*kernel_, device);
    if (!grabbed) return fail(std::move(grabbed).error());
    grabs = *std::move(grabbed);
  }
  return make_hidapi_device(device, *kernel_, std::move(grabs));
}

}  // namespace

std::string hid_library() {
  const hid_api_version* version = hid_version();
  return fmt::format("hidapi {}.{}.{}", version->major, version->minor, version->patch);
}

Result<std::unique_ptr<Hid>> open_hid_bus(Kernel& kernel) {
  if (hid_init() != 0) return fail(ErrorCode::io, "hid", "start hidapi", "the library does not start");
  return std::make_unique<HidapiBus>(kernel);
}

}  // namespace forager::hal
