#include "hal/usb.hpp"

#include <algorithm>

namespace forager::hal {

Result<std::vector<UsbDeviceFacts>> Usb::devices(const UsbMatch& match) {
  auto all = do_devices();
  if (!all) return all;
  all->erase(std::remove_if(all->begin(), all->end(),
                            [&](const UsbDeviceFacts& device) { return !fits(match, device); }),
             all->end());
  std::sort(all->begin(), all->end(),
            [](const UsbDeviceFacts& a, const UsbDeviceFacts& b) { return a.path < b.path; });
  return all;
}

Result<std::unique_ptr<UsbDevice>> Usb::open(const UsbMatch& match) {
  const auto found = devices(match);
  if (!found) return fail(found.error());
  if (found->empty())
    return fail(ErrorCode::not_present, describe(match), "open", "no such device is plugged in",
                "Check the cable and the supply; see what there is: forager usb list");
  if (found->size() > 1) {
    std::string paths;
    for (const UsbDeviceFacts& device : *found) paths += (paths.empty() ? "" : ", ") + device.path;
    return fail(ErrorCode::invalid_argument, describe(match), "open", "several devices fit: at " + paths,
                "Give the serial number or the path of the one that is meant");
  }
  return do_open(found->front());
}

Result<std::unique_ptr<UsbDevice>> open_when_permitted(Usb& usb, const UsbMatch& match, Clock& clock,
                                                       Duration at_most) {
  constexpr Duration kBetween = std::chrono::milliseconds(20);  // udev takes some tens of milliseconds
  const Deadline deadline(clock.now(), at_most);
  while (true) {
    auto device = usb.open(match);
    if (device || device.error().code != ErrorCode::permission || deadline.expired(clock.now()))
      return device;
    clock.sleep_until(clock.now() + kBetween);
  }
}

}  // namespace forager::hal
