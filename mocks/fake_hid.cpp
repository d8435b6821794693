#include "mocks/fake_hid.hpp"

#include <algorithm>
#include <utility>

namespace forager::mocks {

using hal::ErrorCode;

namespace {

class FakeHidDevice final : public hal::HidDevice {
 public:
  FakeHidDevice(std::shared_ptr<FakeHidSocket> socket, bool exclusive)
      : hal::HidDevice(socket->facts), socket_(std::move(socket)), exclusive_(exclusive) {
    if (exclusive_) socket_->exclusive = true;
  }
  ~FakeHidDevice() override {
    if (exclusive_) socket_->exclusive = false;
  }
  FakeHidDevice(const FakeHidDevice&) = delete;
  FakeHidDevice& operator=(const FakeHidDevice&) = delete;

 private:
  hal::Result<> admit(const std::string& operation) {
    if (socket_->next_error) return hal::fail(*std::exchange(socket_->next_error, std::nullopt));
    if (!socket_->plugged) return failed(ErrorCode::disconnected, operation, "the plug is out");
    return {};
  }
  hal::Result<std::size_t> do_read(std::span<std::byte> into, hal::Duration) override {
    if (auto admitted = admit("read"); !admitted) return hal::fail(std::move(admitted).error());
    const std::size_t got = socket_->device->input(into);
    if (got > 0 && !socket_->exclusive) ++socket_->shared_reports;
    return got;
  }
  hal::Result<> do_write(std::span<const std::byte> report) override {
    FORAGER_TRY(admit("write"));
    if (!socket_->device->output(report)) return failed(ErrorCode::refused, "write", "the device stalled");
    return {};
  }
  hal::Result<std::size_t> do_get_feature(std::span<std::byte> into) override {
    if (auto admitted = admit("get feature report"); !admitted) return hal::fail(std::move(admitted).error());
    const auto got = socket_->device->get_feature(into);
    if (!got) return failed(ErrorCode::refused, "get feature report", "the device stalled");
    return *got;
  }
  hal::Result<> do_send_feature(std::span<const std::byte> report) override {
    FORAGER_TRY(admit("send feature report"));
    if (!socket_->device->set_feature(report))
      return failed(ErrorCode::refused, "send feature report", "the device stalled");
    return {};
  }

  std::shared_ptr<FakeHidSocket> socket_;
  bool exclusive_;
};

}  // namespace

std::shared_ptr<FakeHidSocket> FakeHid::socket_of(const SimHidDevice& device) const {
  const auto found = std::find_if(sockets_.begin(), sockets_.end(),
                                  [&](const auto& socket) { return socket->device == &device; });
  return found == sockets_.end() ? nullptr : *found;
}

void FakeHid::plug(SimHidDevice& device) {
  auto socket = std::make_shared<FakeHidSocket>();
  socket->device = &device;
  socket->facts = device.facts();
  device.power(true);
  sockets_.push_back(std::move(socket));
}

void FakeHid::unplug(SimHidDevice& device) {
  const auto socket = socket_of(device);
  if (!socket) return;
  socket->plugged = false;
  device.power(false);
  sockets_.erase(std::find(sockets_.begin(), sockets_.end(), socket));
}

void FakeHid::permit(SimHidDevice& device, bool permitted) {
  if (const auto socket = socket_of(device)) socket->permitted = permitted;
}

void FakeHid::hold(SimHidDevice& device, std::string driver) {
  const auto socket = socket_of(device);
  if (!socket) return;
  socket->facts.path.clear();
  socket->facts.driver = std::move(driver);
}

void FakeHid::fail_next(SimHidDevice& device, hal::Error error) {
  if (const auto socket = socket_of(device)) socket->next_error = std::move(error);
}

std::uint32_t FakeHid::leaked(const SimHidDevice& device) const {
  const auto socket = socket_of(device);
  return socket ? socket->shared_reports : 0;
}

hal::Result<std::vector<hal::HidDeviceFacts>> FakeHid::do_devices() {
  std::vector<hal::HidDeviceFacts> devices;
  for (const auto& socket : sockets_) devices.push_back(socket->facts);
  return devices;
}

hal::Result<std::unique_ptr<hal::HidDevice>> FakeHid::do_open(const hal::HidDeviceFacts& device,
                                                              hal::HidSharing sharing) {
  const bool exclusive = sharing == hal::HidSharing::exclusive;
  for (const auto& socket : sockets_) {
    if (socket->facts.path != device.path) continue;
    if (!socket->permitted)
      return hal::fail(ErrorCode::permission, describe(device), "open", "the operating system forbids it");
    if (exclusive && socket->exclusive)
      return hal::fail(ErrorCode::busy, describe(device), "open", "another program has it for itself");
    return std::make_unique<FakeHidDevice>(socket, exclusive);
  }
  return hal::fail(ErrorCode::disconnected, describe(device), "open", "the plug is out");
}

}  // namespace forager::mocks
