// The functions of libusb 1.0 that the backend calls, over an emulated bus. Defined in the test program, they
// come before those of the library. Transfers and events are in fake_libusb_transfers.cpp.
#include "tests/hal/linux/usb/fake_libusb.hpp"

#include <fmt/format.h>
#include <libusb.h>

#include <memory>
#include <utility>
#include <vector>

#include "tests/hal/linux/usb/fake_libusb_types.hpp"

namespace {

using forager::hal::ErrorCode;
using forager::hal::UsbDeviceFacts;
namespace fake = forager::hal::fake;

constexpr forager::hal::Duration kFrame = std::chrono::milliseconds(1);

class Text final : public fake::Node {
 public:
  explicit Text(std::string text) : text_(std::move(text)) {}
  long read(std::string& into) override {
    into = text_ + "\n";
    return static_cast<long>(into.size());
  }

 private:
  std::string text_;
};

std::unique_ptr<fake::Libusb>& instance() {
  static auto libusb = std::make_unique<fake::Libusb>();
  return libusb;
}

// Devices by path; holds one reference of each.
struct Known {
  Known() = default;
  ~Known() { clear(); }
  Known(const Known&) = delete;
  Known& operator=(const Known&) = delete;
  void clear() {
    for (const auto& [path, device] : devices) libusb_unref_device(device);
    devices.clear();
  }
  std::map<std::string, libusb_device*> devices;
};
Known known;  // NOLINT

std::string& driver_of(const libusb_device_handle* handle, int interface) {
  return fake::libusb().drivers[fmt::format("{}:{}", handle->path, interface)];
}

}  // namespace

namespace forager::hal::fake {

Libusb& libusb() { return *instance(); }

int libusb_error_of(const Error& error) {
  switch (error.code) {
    case ErrorCode::disconnected:
      return LIBUSB_ERROR_NO_DEVICE;
    case ErrorCode::permission:
      return LIBUSB_ERROR_ACCESS;
    case ErrorCode::busy:
      return LIBUSB_ERROR_BUSY;
    case ErrorCode::timeout:
      return LIBUSB_ERROR_TIMEOUT;
    case ErrorCode::refused:
      return LIBUSB_ERROR_PIPE;
    case ErrorCode::protocol:
      return LIBUSB_ERROR_OVERFLOW;
    default:
      return LIBUSB_ERROR_IO;
  }
}

libusb_device* libusb_device_at(const UsbDeviceFacts& facts) {
  auto& device = known.devices[facts.path];
  if (device == nullptr) device = new libusb_device(facts);
  return device;
}

void forget_libusb_device(const std::string& path) {
  const auto found = known.devices.find(path);
  if (found == known.devices.end()) return;
  libusb_unref_device(found->second);
  known.devices.erase(found);
}

void forget_libusb_devices() { known.clear(); }

bool libusb_plugged(const std::string& path) { return !libusb().usb.devices({.path = path}).value().empty(); }

void new_libusb() {
  forget_libusb_devices();
  forget_libusb_transfers();
  instance() = std::make_unique<Libusb>();
}

void Libusb::describe_in_sysfs(const UsbDeviceFacts& facts) {
  const std::string folder = "/sys/bus/usb/devices/" + facts.path;
  kernel.files[folder + "/serial"] = std::make_shared<Text>(facts.serial);
  kernel.files[folder + "/manufacturer"] = std::make_shared<Text>(facts.manufacturer);
  kernel.files[folder + "/product"] = std::make_shared<Text>(facts.product_name);
  for (const UsbInterfaceFacts& interface : facts.interfaces)
    if (!interface.driver.empty())
      kernel.links[fmt::format("{}:1.{}/driver", folder, interface.number)] =
          "../../../../bus/usb/drivers/" + interface.driver;
}

}  // namespace forager::hal::fake

extern "C" {

int libusb_init(libusb_context** context) {
  if (auto& wanted = fake::libusb().fail_init) return *wanted;
  *context = new libusb_context;
  ++fake::libusb().contexts;
  return 0;
}
void libusb_exit(libusb_context* context) {
  delete context;
  --fake::libusb().contexts;
}
const libusb_version* libusb_get_version() {
  static const libusb_version version{1, 0, 26, 0, "", ""};
  return &version;
}
int libusb_has_capability(std::uint32_t) { return fake::libusb().hotplug ? 1 : 0; }
const char* libusb_error_name(int) { return "LIBUSB_ERROR_OF_A_TEST"; }

libusb_device* libusb_ref_device(libusb_device* device) {
  ++device->references;
  return device;
}
void libusb_unref_device(libusb_device* device) {
  if (--device->references == 0) delete device;
}
ssize_t libusb_get_device_list(libusb_context*, libusb_device*** list) {
  const auto devices = fake::libusb().usb.devices().value();
  *list = new libusb_device* [devices.size() + 1] {};
  for (std::size_t i = 0; i < devices.size(); ++i)
    (*list)[i] = libusb_ref_device(fake::libusb_device_at(devices[i]));
  return static_cast<ssize_t>(devices.size());
}
void libusb_free_device_list(libusb_device** list, int) { delete[] list; }

int libusb_get_device_descriptor(libusb_device* device, libusb_device_descriptor* descriptor) {
  *descriptor = {};
  descriptor->idVendor = device->facts.vendor;
  descriptor->idProduct = device->facts.product;
  descriptor->bcdDevice = device->facts.release;
  return 0;
}
int libusb_get_active_config_descriptor(libusb_device* device, libusb_config_descriptor** config) {
  if (device->interfaces.empty()) {
    const auto& all = device->facts.interfaces;
    device->endpoints.resize(all.size());
    device->settings.resize(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (const auto& endpoint : all[i].endpoints) {
        libusb_endpoint_descriptor descriptor{};
        descriptor.bEndpointAddress = endpoint.address;
        descriptor.bmAttributes = static_cast<std::uint8_t>(endpoint.type);
        descriptor.wMaxPacketSize = endpoint.max_packet_bytes;
        device->endpoints[i].push_back(descriptor);
      }
      libusb_interface_descriptor& setting = device->settings[i];
      setting.bInterfaceNumber = all[i].number;
      setting.bInterfaceClass = all[i].class_code;
      setting.bInterfaceSubClass = all[i].subclass;
      setting.bInterfaceProtocol = all[i].protocol;
      setting.bNumEndpoints = static_cast<std::uint8_t>(device->endpoints[i].size());
      setting.endpoint = device->endpoints[i].data();
      device->interfaces.push_back({&setting, 1});
    }
    device->config.bConfigurationValue = 1;
    device->config.bNumInterfaces = static_cast<std::uint8_t>(all.size());
    device->config.interface = device->interfaces.data();
  }
  *config = &device->config;
  return 0;
}
void libusb_free_config_descriptor(libusb_config_descriptor*) {}

// "1-2.4": bus 1, port 2 of the root hub, port 4 of the hub there.
std::uint8_t libusb_get_bus_number(libusb_device* device) {
  return static_cast<std::uint8_t>(std::stoi(device->facts.path));
}
int libusb_get_port_numbers(libusb_device* device, std::uint8_t* ports, int) {
  int depth = 0;
  std::size_t at = device->facts.path.find('-');
  while (at != std::string::npos) {
    ports[depth++] = static_cast<std::uint8_t>(std::stoi(device->facts.path.substr(at + 1)));
    at = device->facts.path.find('.', at + 1);
  }
  return depth;
}

int libusb_open(libusb_device* device, libusb_device_handle** handle) {
  auto opened = fake::libusb().usb.open({.path = device->facts.path});
  if (!opened)
    return opened.error().code == ErrorCode::not_present ? LIBUSB_ERROR_NO_DEVICE
                                                         : fake::libusb_error_of(opened.error());
  *handle = new libusb_device_handle{*std::move(opened), device->facts.path};
  ++fake::libusb().open_handles;
  return 0;
}
void libusb_close(libusb_device_handle* handle) {
  delete handle;
  --fake::libusb().open_handles;
}
int libusb_kernel_driver_active(libusb_device_handle* handle, int interface) {
  return driver_of(handle, interface).empty() ? 0 : 1;
}
int libusb_detach_kernel_driver(libusb_device_handle* handle, int interface) {
  std::string& driver = driver_of(handle, interface);
  if (driver.empty()) return LIBUSB_ERROR_NOT_FOUND;
  fake::libusb().drivers[fmt::format("{}:{} was", handle->path, interface)] = std::exchange(driver, "");
  return 0;
}
int libusb_attach_kernel_driver(libusb_device_handle* handle, int interface) {
  if (!fake::libusb_plugged(handle->path)) return LIBUSB_ERROR_NO_DEVICE;
  driver_of(handle, interface) = fake::libusb().drivers[fmt::format("{}:{} was", handle->path, interface)];
  return 0;
}
int libusb_claim_interface(libusb_device_handle* handle, int interface) {
  if (auto& wanted = fake::libusb().fail_claim) return *std::exchange(wanted, std::nullopt);
  if (!driver_of(handle, interface).empty()) return LIBUSB_ERROR_BUSY;
  const auto claimed = handle->device->claim(static_cast<std::uint8_t>(interface));
  return claimed ? 0 : fake::libusb_error_of(claimed.error());
}
int libusb_release_interface(libusb_device_handle* handle, int interface) {
  const auto released = handle->device->release(static_cast<std::uint8_t>(interface));
  return released ? 0 : fake::libusb_error_of(released.error());
}
int libusb_clear_halt(libusb_device_handle* handle, unsigned char endpoint) {
  const auto cleared = handle->device->clear_halt(endpoint);
  return cleared ? 0 : fake::libusb_error_of(cleared.error());
}

int libusb_control_transfer(libusb_device_handle* handle, std::uint8_t type, std::uint8_t request,
                            std::uint16_t value, std::uint16_t index, unsigned char* data,
                            std::uint16_t length, unsigned timeout) {
  if (auto& wanted = fake::libusb().fail_sync) return *std::exchange(wanted, std::nullopt);
  using forager::hal::UsbRecipient;
  using forager::hal::UsbRequestKind;
  const forager::hal::UsbRequest asked{static_cast<UsbRequestKind>(type >> 5U & 3U),
                                       static_cast<UsbRecipient>(type & 0x1FU), request, value, index};
  const std::span<std::byte> memory(reinterpret_cast<std::byte*>(data), length);
  if ((type & 0x80U) != 0) {
    const auto got = handle->device->control_in(asked, memory, timeout * kFrame);
    return got ? static_cast<int>(*got) : fake::libusb_error_of(got.error());
  }
  const auto put = handle->device->control_out(asked, memory, timeout * kFrame);
  return put ? length : fake::libusb_error_of(put.error());
}
int libusb_bulk_transfer(libusb_device_handle* handle, unsigned char endpoint, unsigned char* data,
                         int length, int* moved, unsigned timeout) {
  *moved = 0;
  if (auto& wanted = fake::libusb().fail_sync) return *std::exchange(wanted, std::nullopt);
  const std::span<std::byte> memory(reinterpret_cast<std::byte*>(data), static_cast<std::size_t>(length));
  if ((endpoint & 0x80U) != 0) {
    const auto got = handle->device->bulk_in(endpoint, memory, timeout * kFrame);
    *moved = got ? static_cast<int>(*got) : 0;
    return got ? 0 : fake::libusb_error_of(got.error());
  }
  const auto put = handle->device->bulk_out(endpoint, memory, timeout * kFrame);
  *moved = put ? length : 0;
  return put ? 0 : fake::libusb_error_of(put.error());
}
int libusb_interrupt_transfer(libusb_device_handle* handle, unsigned char endpoint, unsigned char* data,
                              int length, int* moved, unsigned timeout) {
  return libusb_bulk_transfer(handle, endpoint, data, length, moved, timeout);
}

}  // extern "C"
