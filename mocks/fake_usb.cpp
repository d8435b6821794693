#include "mocks/fake_usb.hpp"

#include <algorithm>
#include <utility>

#include "mocks/fake_usb_device.hpp"

namespace forager::mocks {

FakeUsbSocket* FakeUsb::socket_of(const SimUsbDevice& device) {
  const auto found = std::find_if(sockets_.begin(), sockets_.end(),
                                  [&](const auto& socket) { return socket->device == &device; });
  return found == sockets_.end() ? nullptr : found->get();
}

void FakeUsb::plug(SimUsbDevice& device, bool permitted) {
  auto socket = std::make_shared<FakeUsbSocket>();
  socket->device = &device;
  socket->facts = device.facts();
  socket->permitted = permitted;
  for (const hal::UsbInterfaceFacts& interface : socket->facts.interfaces)
    socket->drivers.push_back(interface.driver);
  socket->claimed.resize(socket->drivers.size());
  device.power(true);
  events_.push_back({.arrived = true, .permitted = permitted, .device = socket->facts});
  sockets_.push_back(std::move(socket));
}

void FakeUsb::unplug(SimUsbDevice& device) {
  FakeUsbSocket* socket = socket_of(device);
  if (socket == nullptr) return;
  for (const auto& [who, arrive] : socket->before_unplug) arrive();
  socket->plugged = false;
  device.power(false);
  events_.push_back({.arrived = false, .permitted = socket->permitted, .device = socket->facts});
  sockets_.erase(std::find_if(sockets_.begin(), sockets_.end(),
                              [&](const auto& candidate) { return candidate.get() == socket; }));
}

void FakeUsb::permit(SimUsbDevice& device) {
  if (FakeUsbSocket* socket = socket_of(device)) socket->permitted = true;
}

void FakeUsb::fail_next(SimUsbDevice& device, hal::Error error) {
  if (FakeUsbSocket* socket = socket_of(device)) socket->next_error = std::move(error);
}

hal::Result<std::vector<hal::UsbDeviceFacts>> FakeUsb::do_devices() {
  std::vector<hal::UsbDeviceFacts> devices;
  for (const auto& socket : sockets_) devices.push_back(socket->facts);
  return devices;
}

hal::Result<std::unique_ptr<hal::UsbDevice>> FakeUsb::do_open(const hal::UsbDeviceFacts& device) {
  for (const auto& socket : sockets_) {
    if (socket->facts.path != device.path) continue;
    if (!socket->permitted)
      return hal::fail(hal::ErrorCode::permission, describe(device), "open",
                       "the operating system forbids it");
    return std::make_unique<FakeUsbDevice>(socket);
  }
  return hal::fail(hal::ErrorCode::disconnected, describe(device), "open", "the plug is out");
}

hal::Result<std::vector<hal::UsbEvent>> FakeUsb::do_update(hal::Instant) {
  return std::exchange(events_, {});
}

}  // namespace forager::mocks
