// The functions of hidapi that the backend calls, over emulated devices. Defined in the test program, they
// come before those of the library.
#include "tests/hal/linux/hid/fake_hidapi.hpp"

#include <fmt/format.h>
#include <hidapi.h>
#include <linux/input.h>

#include <cerrno>
#include <chrono>
#include <cwchar>
#include <memory>
#include <string>
#include <utility>

namespace {

namespace fake = forager::hal::fake;
using forager::hal::ErrorCode;

std::unique_ptr<fake::Hidapi>& instance() {
  static auto hidapi = std::make_unique<fake::Hidapi>();
  return hidapi;
}

wchar_t* wide(const std::string& text) {
  auto* copy = new wchar_t[text.size() + 1]{};
  for (std::size_t i = 0; i < text.size(); ++i) copy[i] = static_cast<wchar_t>(text[i]);
  return copy;
}

int fail_with(const forager::hal::Error& error) {
  errno = error.code == ErrorCode::disconnected ? ENODEV : error.code == ErrorCode::refused ? EPIPE : EIO;
  return -1;
}

class Text final : public fake::Node {
 public:
  explicit Text(std::string text) : text_(std::move(text)) {}
  long read(std::string& into) override {
    into = text_;
    return static_cast<long>(into.size());
  }

 private:
  std::string text_;
};

}  // namespace

struct hid_device_ {
  std::unique_ptr<forager::hal::HidDevice> device;
};

namespace forager::hal::fake {

int DeviceFile::ioctl(unsigned long request, void* argument) {
  if (request != EVIOCGRAB) return -EINVAL;
  if (refuse_grab != 0) return -refuse_grab;
  grabbed = argument != nullptr;
  return 0;
}

void Hidapi::show(const HidDeviceFacts& facts, int count, const std::string& event) {
  const std::string folder =
      fmt::format("/sys/bus/hid/devices/0003:{:04X}:{:04X}.{:04X}", facts.vendor, facts.product, count);
  kernel.files[folder + "/uevent"] =
      std::make_shared<Text>(fmt::format("HID_NAME={}\nHID_UNIQ={}\n", facts.product_name, facts.serial));
  kernel.links[folder + "/driver"] = "../../../../bus/hid/drivers/" + facts.driver;
  if (!facts.path.empty()) {
    const std::string raw = facts.path.substr(facts.path.find_last_of('/') + 1);
    kernel.files[folder + "/hidraw/" + raw + "/dev"] = std::make_shared<Text>("240:0");
    kernel.files[facts.path] = std::make_shared<DeviceFile>();
  }
  if (event.empty()) return;
  kernel.files[folder + "/input/input7/name"] = std::make_shared<Text>(facts.product_name);
  kernel.files[folder + "/input/input7/" + event + "/dev"] = std::make_shared<Text>("13:64");
  kernel.files["/dev/input/" + event] = std::make_shared<DeviceFile>();
}

Hidapi& hidapi() { return *instance(); }
void new_hidapi() { instance() = std::make_unique<Hidapi>(); }

}  // namespace forager::hal::fake

extern "C" {

int hid_init() {
  ++fake::hidapi().initialised;
  return 0;
}
int hid_exit() {
  --fake::hidapi().initialised;
  return 0;
}
const hid_api_version* hid_version() {
  static const hid_api_version version{0, 13, 1};
  return &version;
}
hid_device_info* hid_enumerate(unsigned short, unsigned short) {
  hid_device_info* first = nullptr;
  const auto devices = fake::hidapi().hid.devices().value();
  for (auto each = devices.rbegin(); each != devices.rend(); ++each) {
    if (each->path.empty()) continue;                          // hidapi sees hidraw only
    for (int collection = 1; collection >= 0; --collection) {  // one entry a collection, the first one first
      auto* info = new hid_device_info{};
      info->path = new char[each->path.size() + 1]{};
      each->path.copy(info->path, each->path.size());
      info->vendor_id = each->vendor;
      info->product_id = each->product;
      info->serial_number = wide(each->serial);
      info->manufacturer_string = wide(each->manufacturer);
      info->product_string = wide(each->product_name);
      info->usage_page = collection == 0 ? each->usage_page : static_cast<unsigned short>(0x000C);
      info->usage = collection == 0 ? each->usage : static_cast<unsigned short>(1);
      info->interface_number = each->interface_number;
      info->next = std::exchange(first, info);
    }
  }
  return first;
}
void hid_free_enumeration(hid_device_info* first) {
  while (first != nullptr) {
    hid_device_info* next = first->next;
    delete[] first->path;
    delete[] first->serial_number;
    delete[] first->manufacturer_string;
    delete[] first->product_string;
    delete std::exchange(first, next);
  }
}
hid_device* hid_open_path(const char* path) {
  forager::hal::HidMatch match;
  match.path = path;
  auto opened = fake::hidapi().hid.open(match);
  if (!opened) {
    fail_with(opened.error());
    return nullptr;
  }
  ++fake::hidapi().open_devices;
  return new hid_device{*std::move(opened)};
}
void hid_close(hid_device* device) {
  delete device;
  --fake::hidapi().open_devices;
}
int hid_write(hid_device* device, const unsigned char* data, std::size_t length) {
  const auto put = device->device->write({reinterpret_cast<const std::byte*>(data), length});
  return put ? static_cast<int>(length) : fail_with(put.error());
}
int hid_read_timeout(hid_device* device, unsigned char* data, std::size_t length, int milliseconds) {
  const std::span<std::byte> into(reinterpret_cast<std::byte*>(data), length);
  const auto got = milliseconds == 0 ? device->device->poll(into)
                                     : device->device->read(into, std::chrono::milliseconds(milliseconds));
  if (!got && got.error().code == ErrorCode::timeout) return 0;
  return got ? static_cast<int>(*got) : fail_with(got.error());
}
int hid_send_feature_report(hid_device* device, const unsigned char* data, std::size_t length) {
  const auto put = device->device->send_feature({reinterpret_cast<const std::byte*>(data), length});
  return put ? static_cast<int>(length) : fail_with(put.error());
}
int hid_get_feature_report(hid_device* device, unsigned char* data, std::size_t length) {
  const auto got = device->device->get_feature({reinterpret_cast<std::byte*>(data), length});
  return got ? static_cast<int>(*got) : fail_with(got.error());
}

}  // extern "C"
