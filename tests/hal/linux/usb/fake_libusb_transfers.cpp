// Transfers and events of libusb 1.0 over an emulated bus; the rest is in fake_libusb.cpp.
#include <libusb.h>

#include <algorithm>
#include <deque>
#include <utility>
#include <vector>

#include "tests/hal/linux/usb/fake_libusb.hpp"
#include "tests/hal/linux/usb/fake_libusb_types.hpp"

namespace {

using forager::hal::ErrorCode;
namespace fake = forager::hal::fake;

constexpr std::size_t kPacket = 64;
constexpr forager::hal::Duration kFrame = std::chrono::milliseconds(1);

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
    transfer.status =
        got ? LIBUSB_TRANSFER_COMPLETED
            : static_cast<libusb_transfer_status>(status_of(fake::libusb_error_of(got.error())));
    return true;
  }
  while (each.sent < length) {
    const std::size_t size = std::min(kPacket, length - each.sent);
    const auto put = device.bulk_out(transfer.endpoint, {memory + each.sent, size}, kFrame);
    if (!put && put.error().code == ErrorCode::timeout) return false;
    if (!put) {
      transfer.status = static_cast<libusb_transfer_status>(status_of(fake::libusb_error_of(put.error())));
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
    libusb_device* device = fake::libusb_device_at(event.device);
    listener.call(context, device,
                  event.arrived ? LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED : LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT,
                  listener.user);
    if (event.arrived) continue;
    fake::forget_libusb_device(event.device.path);
  }
}

}  // namespace

void forager::hal::fake::forget_libusb_transfers() {
  submitted.clear();
  listener = {};
}

extern "C" {

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
  if (!fake::libusb_plugged(transfer->dev_handle->path)) return LIBUSB_ERROR_NO_DEVICE;
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
