// libusb 1.0. Twin: absent_libusb_bus.cpp.
#include <fmt/format.h>
#include <libusb.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "hal/linux/libusb_device.hpp"
#include "hal/linux/libusb_error.hpp"
#include "hal/linux/usb_bus.hpp"

namespace forager::hal {
namespace {

constexpr std::string_view kSysfs = "/sys/bus/usb/devices/";

struct Unref {
  void operator()(libusb_device* device) const { libusb_unref_device(device); }
};
using Device = std::unique_ptr<libusb_device, Unref>;

// The name sysfs gives it; empty: a root hub, which nobody plugs in.
std::string path_of(libusb_device* device) {
  std::array<std::uint8_t, 7> ports{};  // USB 3.1, section 10.1: at most five hubs between
  const int depth = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
  if (depth <= 0) return {};
  std::string path = fmt::format("{}-{}", libusb_get_bus_number(device), ports[0]);
  for (int i = 1; i < depth; ++i) path += fmt::format(".{}", ports[static_cast<std::size_t>(i)]);
  return path;
}

UsbInterfaceFacts facts_of(const libusb_interface_descriptor& interface) {
  UsbInterfaceFacts facts{.number = interface.bInterfaceNumber,
                          .class_code = interface.bInterfaceClass,
                          .subclass = interface.bInterfaceSubClass,
                          .protocol = interface.bInterfaceProtocol};
  for (int i = 0; i < interface.bNumEndpoints; ++i) {
    const libusb_endpoint_descriptor& endpoint = interface.endpoint[i];
    facts.endpoints.push_back({endpoint.bEndpointAddress,
                               static_cast<UsbTransferType>(endpoint.bmAttributes & 0x03U),
                               static_cast<std::uint16_t>(endpoint.wMaxPacketSize & 0x07FFU)});
  }
  return facts;
}

UsbDeviceFacts facts_of(libusb_device* device, Kernel& kernel) {
  UsbDeviceFacts facts;
  libusb_device_descriptor descriptor{};
  libusb_get_device_descriptor(device, &descriptor);
  facts.vendor = descriptor.idVendor;
  facts.product = descriptor.idProduct;
  facts.release = descriptor.bcdDevice;
  facts.path = path_of(device);
  const std::string folder = std::string(kSysfs) + facts.path;
  const auto text = [&](std::string_view name) {
    return read_file(kernel, fmt::format("{}/{}", folder, name)).value_or("");
  };
  facts.serial = text("serial");
  facts.manufacturer = text("manufacturer");
  facts.product_name = text("product");
  libusb_config_descriptor* config = nullptr;
  if (libusb_get_active_config_descriptor(device, &config) != 0) return facts;
  for (int i = 0; i < config->bNumInterfaces; ++i) {
    if (config->interface[i].num_altsetting == 0) continue;
    UsbInterfaceFacts interface = facts_of(config->interface[i].altsetting[0]);
    const std::string driver =
        kernel.link(fmt::format("{}:{}.{}/driver", folder, config->bConfigurationValue, interface.number));
    interface.driver = driver.substr(driver.find_last_of('/') + 1);
    facts.interfaces.push_back(std::move(interface));
  }
  libusb_free_config_descriptor(config);
  return facts;
}

class LibusbBus final : public Usb {
 public:
  LibusbBus(std::shared_ptr<libusb_context> context, const UsbBusConfig& config, Kernel& kernel)
      : context_(std::move(context)), config_(config), kernel_(&kernel), name_("usb by " + usb_library()) {}
  ~LibusbBus() override {
    if (registered_) libusb_hotplug_deregister_callback(context_.get(), callback_);
  }
  LibusbBus(const LibusbBus&) = delete;
  LibusbBus& operator=(const LibusbBus&) = delete;

  Result<> listen();

 private:
  struct Plug {
    Device device;
    bool arrived = false;
    std::optional<Instant> first_tried;
  };

  Result<std::vector<UsbDeviceFacts>> do_devices() override;
  Result<std::unique_ptr<UsbDevice>> do_open(const UsbDeviceFacts& device) override;
  Result<std::vector<UsbEvent>> do_update(Instant now) override;
  [[nodiscard]] std::string_view do_name() const override { return name_; }

  Result<std::vector<Device>> list();
  // Tells of it, and says whether it is done with.
  bool tell(Plug& plug, Instant now, std::vector<UsbEvent>& events);

  std::shared_ptr<libusb_context> context_;
  UsbBusConfig config_;
  Kernel* kernel_;
  std::string name_;
  libusb_hotplug_callback_handle callback_{};
  bool registered_ = false;
  std::vector<Plug> plugs_;                           // not told of yet, in order
  std::map<libusb_device*, UsbDeviceFacts> present_;  // told of: sysfs forgets them when they leave
};

// Without udev (a bare container) libusb cannot tell of plugs: devices present at the start are all there is.
Result<> LibusbBus::listen() {
  const auto plugged = [](libusb_context*, libusb_device* device, libusb_hotplug_event event, void* self) {
    const bool arrived = event == LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED;
    static_cast<LibusbBus*>(self)->plugs_.push_back({Device(libusb_ref_device(device)), arrived, {}});
    return 0;
  };
  constexpr int kBoth = LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED | LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT;
  const int answer = libusb_hotplug_register_callback(context_.get(), kBoth, LIBUSB_HOTPLUG_ENUMERATE,
                                                      LIBUSB_HOTPLUG_MATCH_ANY, LIBUSB_HOTPLUG_MATCH_ANY,
                                                      LIBUSB_HOTPLUG_MATCH_ANY, plugged, this, &callback_);
  if (answer != 0) return libusb_failure("usb", "listen for plugs", answer);
  registered_ = true;
  return {};
}

Result<std::vector<Device>> LibusbBus::list() {
  libusb_device** all = nullptr;
  const auto count = libusb_get_device_list(context_.get(), &all);
  if (count < 0) return libusb_failure("usb", "list devices", static_cast<int>(count));
  std::vector<Device> devices;
  for (ssize_t i = 0; i < count; ++i) {
    Device device(all[i]);
    if (!path_of(device.get()).empty()) devices.push_back(std::move(device));
  }
  libusb_free_device_list(all, 0);
  return devices;
}

Result<std::vector<UsbDeviceFacts>> LibusbBus::do_devices() {
  const auto all = list();
  if (!all) return fail(all.error());
  std::vector<UsbDeviceFacts> facts;
  for (const Device& device : *all) facts.push_back(facts_of(device.get(), *kernel_));
  return facts;
}

Result<std::unique_ptr<UsbDevice>> LibusbBus::do_open(const UsbDeviceFacts& wanted) {
  const auto all = list();
  if (!all) return fail(all.error());
  for (const Device& device : *all) {
    if (path_of(device.get()) != wanted.path) continue;
    libusb_device_handle* handle = nullptr;
    if (const int answer = libusb_open(device.get(), &handle); answer != 0)
      return libusb_failure(describe(wanted), "open", answer);
    return make_libusb_device(context_, handle, wanted);
  }
  return libusb_failure(describe(wanted), "open", LIBUSB_ERROR_NO_DEVICE);
}

bool LibusbBus::tell(Plug& plug, Instant now, std::vector<UsbEvent>& events) {
  libusb_device* device = plug.device.get();
  if (path_of(device).empty()) return true;
  if (!plug.arrived) {
    // Who left before it was told of was never there.
    const auto known = present_.find(device);
    if (known == present_.end()) return true;
    events.push_back({.arrived = false, .permitted = true, .device = std::move(known->second)});
    present_.erase(known);
    return true;
  }
  libusb_device_handle* handle = nullptr;
  const int answer = libusb_open(device, &handle);
  if (answer == 0) libusb_close(handle);
  const bool forbidden = answer == LIBUSB_ERROR_ACCESS;
  if (!plug.first_tried) plug.first_tried = now;
  if (forbidden && now - *plug.first_tried < config_.settle) return false;
  UsbDeviceFacts facts = facts_of(device, *kernel_);
  events.push_back({.arrived = true, .permitted = !forbidden, .device = facts});
  present_.insert_or_assign(device, std::move(facts));
  return true;
}

Result<std::vector<UsbEvent>> LibusbBus::do_update(Instant now) {
  timeval at_once{0, 0};
  if (const int answer = libusb_handle_events_timeout_completed(context_.get(), &at_once, nullptr);
      answer != 0 && answer != LIBUSB_ERROR_INTERRUPTED)
    return libusb_failure("usb", "listen for plugs", answer);
  std::vector<UsbEvent> events;
  std::vector<Plug> plugs = std::exchange(plugs_, {});
  for (Plug& plug : plugs) {
    const bool left = std::any_of(plugs.begin(), plugs.end(), [&](const Plug& other) {
      return &other > &plug && other.device == plug.device && !other.arrived;
    });
    if (plug.arrived && left) continue;
    if (!tell(plug, now, events)) plugs_.push_back(std::move(plug));
  }
  return events;
}

}  // namespace

std::string usb_library() {
  const libusb_version* version = libusb_get_version();
  return fmt::format("libusb {}.{}.{}", version->major, version->minor, version->micro);
}

Result<std::unique_ptr<Usb>> open_usb_bus(const UsbBusConfig& config, Kernel& kernel) {
  libusb_context* context = nullptr;
  if (const int answer = libusb_init(&context); answer != 0)
    return libusb_failure("usb", "start libusb", answer);
  auto bus =
      std::make_unique<LibusbBus>(std::shared_ptr<libusb_context>(context, libusb_exit), config, kernel);
  if (libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG) != 0) FORAGER_TRY(bus->listen());
  return bus;
}

}  // namespace forager::hal
