// The functions of libusb 1.0 that the backend calls, over an emulated bus. Defined in the test program, they
// come before those of the library.
#include "tests/hal/linux/usb/fake_libusb.hpp"

#include <fmt/format.h>
#include <libusb.h>

#include <algorithm>
#include <array>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

namespace {

using forager::hal::ErrorCode;
using forager::hal::UsbDeviceFacts;
namespace fake = forager::hal::fake;

constexpr std::size_t kPacket = 64;
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

int error_of(const forager::hal::Error& error) {
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

int status_of(int error) {
  switch (error) {
    case LIBUSB_ERROR_NO_DEVICE:
      return LIBUSB_TRANSFER_NO_DEVICE;
    case LIBUSB_ERROR_PIPE:
      return LIBUSB_TRANSFER_STALL;
    case LIBUSB_ERROR_OVERFLOW:
      return LIBUSB_TRANSFER_OVERFLOW;
    default:
      return LIBUSB_TRANSFER_ERROR;
  }
}

struct Submitted {
  libusb_transfer* transfer;
  std::size_t sent = 0;
  bool cancelled = false;
};
std::deque<Submitted> submitted;  // NOLINT: libusb itself keeps state like this

struct Listener {
  libusb_hotplug_callback_fn call = nullptr;
  void* user = nullptr;
};
Listener listener;  // NOLINT

}  // namespace

struct libusb_context {
  int unused = 0;
};
struct libusb_device {
  explicit libusb_device(UsbDeviceFacts what) : facts(std::move(what)) {}
  UsbDeviceFacts facts;
  int references = 1;
  std::vector<std::vector<libusb_endpoint_descriptor>> endpoints;
  std::vector<libusb_interface_descriptor> settings;
  std::vector<libusb_interface> interfaces;
  libusb_config_descriptor config{};
};
struct libusb_device_handle {
  std::unique_ptr<forager::hal::UsbDevice> device;
  std::string path;
};

namespace {

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

libusb_device* device_at(const UsbDeviceFacts& facts) {
  auto& device = known.devices[facts.path];
  if (device == nullptr) device = new libusb_device(facts);
  return device;
}

bool plugged(const std::string& path) { return !fake::libusb().usb.devices({.path = path}).value().empty(); }

std::string& driver_of(const libusb_device_handle* handle, int interface) {
  return fake::libusb().drivers[fmt::format("{}:{}", handle->path, interface)];
}

// One round of the controller: what happens to a transfer in a frame. True: it has ended.
bool serve(Submitted& each) {
  libusb_transfer& transfer = *each.transfer;
  auto& device = *transfer.dev_handle->device;
  auto* const memory = reinterpret_cast<std::byte*>(transfer.buffer);
  const auto length = static_cast<std::size_t>(transfer.length);
  if (each.cancelled) {
    transfer.status = LIBUSB_TRANSFER_CANCELLED;
    return true;
  }
  if (auto& wanted = fake::libusb().fail_transfer) {
    transfer.status = static_cast<libusb_transfer_status>(*std::exchange(wanted, std::nullopt));
    return true;
  }
  if ((transfer.endpoint & 0x80U) != 0) {
    const auto got = device.bulk_in(transfer.endpoint, {memory, length}, kFrame);
    if (!got && got.error().code == ErrorCode::timeout) return false;
    transfer.actual_length = got ? static_cast<int>(*got) : 0;
    transfer.status = got ? LIBUSB_TRANSFER_COMPLETED
                          : static_cast<libusb_transfer_status>(status_of(error_of(got.error())));
    return true;
  }
  while (each.sent < length) {
    const std::size_t size = std::min(kPacket, length - each.sent);
    const auto put = device.bulk_out(transfer.endpoint, {memory + each.sent, size}, kFrame);
    if (!put && put.error().code == ErrorCode::timeout) return false;
    if (!put) {
      transfer.status = static_cast<libusb_transfer_status>(status_of(error_of(put.error())));
      return true;
    }
    each.sent += size;
    transfer.actual_length = static_cast<int>(each.sent);
  }
  transfer.status = LIBUSB_TRANSFER_COMPLETED;
  return true;
}

void tell_of_plugs(libusb_context* context) {
  const auto events = fake::libusb().usb.update({}).value();
  for (const auto& event : events) {
    if (listener.call == nullptr) continue;
    libusb_device* device = device_at(event.device);
    listener.call(context, device,
                  event.arrived ? LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED : LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT,
                  listener.user);
    if (event.arrived) continue;
    known.devices.erase(event.device.path);
    libusb_unref_device(device);
  }
}

}  // namespace

namespace forager::hal::fake {

Libusb& libusb() { return *instance(); }

void new_libusb() {
  known.clear();
  submitted.clear();
  listener = {};
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
  for (std::size_t i = 0; i < devices.size(); ++i) (*list)[i] = libusb_ref_device(device_at(devices[i]));
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
    return opened.error().code == ErrorCode::not_present ? LIBUSB_ERROR_NO_DEVICE : error_of(opened.error());
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
  if (!plugged(handle->path)) return LIBUSB_ERROR_NO_DEVICE;
  driver_of(handle, interface) = fake::libusb().drivers[fmt::format("{}:{} was", handle->path, interface)];
  return 0;
}
int libusb_claim_interface(libusb_device_handle* handle, int interface) {
  if (auto& wanted = fake::libusb().fail_claim) return *std::exchange(wanted, std::nullopt);
  if (!driver_of(handle, interface).empty()) return LIBUSB_ERROR_BUSY;
  const auto claimed = handle->device->claim(static_cast<std::uint8_t>(interface));
  return claimed ? 0 : error_of(claimed.error());
}
int libusb_release_interface(libusb_device_handle* handle, int interface) {
  const auto released = handle->device->release(static_cast<std::uint8_t>(interface));
  return released ? 0 : error_of(released.error());
}
int libusb_clear_halt(libusb_device_handle* handle, unsigned char endpoint) {
  const auto cleared = handle->device->clear_halt(endpoint);
  return cleared ? 0 : error_of(cleared.error());
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
    return got ? static_cast<int>(*got) : error_of(got.error());
  }
  const auto put = handle->device->control_out(asked, memory, timeout * kFrame);
  return put ? length : error_of(put.error());
}
int libusb_bulk_transfer(libusb_device_handle* handle, unsigned char endpoint, unsigned char* data,
                         int length, int* moved, unsigned timeout) {
  *moved = 0;
  if (auto& wanted = fake::libusb().fail_sync) return *std::exchange(wanted, std::nullopt);
  const std::span<std::byte> memory(reinterpret_cast<std::byte*>(data), static_cast<std::size_t>(length));
  if ((endpoint & 0x80U) != 0) {
    const auto got = handle->device->bulk_in(endpoint, memory, timeout * kFrame);
    *moved = got ? static_cast<int>(*got) : 0;
    return got ? 0 : error_of(got.error());
  }
  const auto put = handle->device->bulk_out(endpoint, memory, timeout * kFrame);
  *moved = put ? length : 0;
  return put ? 0 : error_of(put.error());
}
int libusb_interrupt_transfer(libusb_device_handle* handle, unsigned char endpoint, unsigned char* data,
                              int length, int* moved, unsigned timeout) {
  return libusb_bulk_transfer(handle, endpoint, data, length, moved, timeout);
}

libusb_transfer* libusb_alloc_transfer(int) {
  ++fake::libusb().transfers;
  return new libusb_transfer{};
}
void libusb_free_transfer(libusb_transfer* transfer) {
  if (transfer == nullptr) return;
  delete transfer;
  --fake::libusb().transfers;
}
int libusb_submit_transfer(libusb_transfer* transfer) {
  if (!plugged(transfer->dev_handle->path)) return LIBUSB_ERROR_NO_DEVICE;
  transfer->actual_length = 0;
  submitted.push_back({transfer});
  return 0;
}
int libusb_cancel_transfer(libusb_transfer* transfer) {
  for (Submitted& each : submitted)
    if (each.transfer == transfer) each.cancelled = true;
  return 0;
}
int libusb_handle_events_timeout_completed(libusb_context* context, timeval*, int*) {
  tell_of_plugs(context);
  // In order on each endpoint: what waits holds up those behind it.
  std::vector<std::pair<libusb_device_handle*, unsigned>> waiting;
  std::vector<libusb_transfer*> ended;
  for (auto each = submitted.begin(); each != submitted.end();) {
    const std::pair<libusb_device_handle*, unsigned> place(each->transfer->dev_handle,
                                                           each->transfer->endpoint);
    const bool behind = std::find(waiting.begin(), waiting.end(), place) != waiting.end();
    if ((behind && !each->cancelled) || !serve(*each)) {
      waiting.push_back(place);
      ++each;
      continue;
    }
    ended.push_back(each->transfer);
    each = submitted.erase(each);
  }
  for (libusb_transfer* transfer : ended) transfer->callback(transfer);
  return 0;
}
int libusb_hotplug_register_callback(libusb_context*, int, int, int, int, int,
                                     libusb_hotplug_callback_fn call, void* user,
                                     libusb_hotplug_callback_handle*) {
  listener = {call, user};
  return 0;
}
void libusb_hotplug_deregister_callback(libusb_context*, libusb_hotplug_callback_handle) { listener = {}; }

}  // extern "C"
