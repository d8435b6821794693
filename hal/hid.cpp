#include "hal/hid.hpp"

#include <algorithm>

namespace forager::hal {

Result<std::vector<HidDeviceFacts>> Hid::devices(const HidMatch& match) {
  auto all = do_devices();
  if (!all) return all;
  all->erase(std::remove_if(all->begin(), all->end(),
                            [&](const HidDeviceFacts& device) { return !fits(match, device); }),
             all->end());
  std::sort(all->begin(), all->end(),
            [](const HidDeviceFacts& a, const HidDeviceFacts& b) { return a.path < b.path; });
  return all;
}

Result<std::unique_ptr<HidDevice>> Hid::open(const HidMatch& match, HidSharing sharing) {
  const auto found = devices(match);
  if (!found) return fail(found.error());
  if (found->empty())
    return fail(ErrorCode::not_present, describe(match), "open", "no such device is plugged in",
                "Check the cable; see what there is: forager hid list");
  if (found->size() > 1) {
    std::string paths;
    for (const HidDeviceFacts& device : *found) paths += (paths.empty() ? "" : ", ") + describe(device);
    return fail(ErrorCode::invalid_argument, describe(match), "open", "several devices fit: " + paths,
                "Give the serial number, the interface or the path of the one that is meant");
  }
  const HidDeviceFacts& device = found->front();
  if (device.path.empty())
    return fail(ErrorCode::busy, describe(match), "open",
                "the kernel's driver " + device.driver + " has it and leaves no hidraw",
                "Take it from the kernel: blacklist that driver's module in /etc/modprobe.d and plug the "
                "device in again");
  return do_open(device, sharing);
}

}  // namespace forager::hal
