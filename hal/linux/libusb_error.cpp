#include "hal/linux/libusb_error.hpp"

#include <libusb.h>

#include <algorithm>
#include <limits>

namespace forager::hal {
namespace {

struct Meaning {
  int error;
  ErrorCode code;
  std::string_view detail;
  std::string_view mend;
};

constexpr Meaning kMeanings[] = {
    {LIBUSB_ERROR_NO_DEVICE, ErrorCode::disconnected, "the plug was pulled",
     "Check the cable and its strain relief; a hub that resets its ports does the same"},
    {LIBUSB_ERROR_ACCESS, ErrorCode::permission, "the operating system forbids it",
     "Install boards/99-forager.rules into /etc/udev/rules.d, join the group plugdev, log in again and plug "
     "the "
     "device in again"},
    {LIBUSB_ERROR_BUSY, ErrorCode::busy, "another program has it",
     "Stop that program; lsof /dev/bus/usb/*/* tells"},
    {LIBUSB_ERROR_TIMEOUT, ErrorCode::timeout, "the device did not answer in time", ""},
    {LIBUSB_ERROR_PIPE, ErrorCode::refused,
     "the device stalled: it does not know this, or the endpoint is halted", ""},
    {LIBUSB_ERROR_OVERFLOW, ErrorCode::protocol, "the device sent more than was asked for", ""},
    {LIBUSB_ERROR_NOT_FOUND, ErrorCode::not_present, "there is no such interface, or it was released", ""},
    {LIBUSB_ERROR_NOT_SUPPORTED, ErrorCode::unsupported, "this system cannot do that", ""},
    {LIBUSB_ERROR_INVALID_PARAM, ErrorCode::invalid_argument, "the system takes no such transfer", ""},
    {LIBUSB_ERROR_IO, ErrorCode::io, "the transfer failed, as by noise, a bad cable or a plug half out",
     "Try another cable and another port, without a hub"}};

}  // namespace

Failure libusb_failure(std::string_view device, std::string operation, int error) {
  const auto* const meaning = std::find_if(std::begin(kMeanings), std::end(kMeanings),
                                           [&](const Meaning& known) { return known.error == error; });
  if (meaning == std::end(kMeanings))
    return fail(ErrorCode::io, std::string(device), std::move(operation),
                std::string("libusb failed: ") + libusb_error_name(error));
  return fail(meaning->code, std::string(device), std::move(operation), std::string(meaning->detail),
              std::string(meaning->mend));
}

int libusb_error_of_transfer(int status) {
  switch (status) {
    case LIBUSB_TRANSFER_TIMED_OUT:
      return LIBUSB_ERROR_TIMEOUT;
    case LIBUSB_TRANSFER_STALL:
      return LIBUSB_ERROR_PIPE;
    case LIBUSB_TRANSFER_NO_DEVICE:
      return LIBUSB_ERROR_NO_DEVICE;
    case LIBUSB_TRANSFER_OVERFLOW:
      return LIBUSB_ERROR_OVERFLOW;
    case LIBUSB_TRANSFER_CANCELLED:
      return LIBUSB_ERROR_INTERRUPTED;
    default:
      return LIBUSB_ERROR_IO;
  }
}

unsigned libusb_milliseconds(Duration at_most) {
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(at_most).count();
  return static_cast<unsigned>(std::clamp<std::int64_t>(ms, 1, std::numeric_limits<int>::max()));
}

}  // namespace forager::hal
