#pragma once

#include <memory>
#include <vector>

#include "hal/hid_device.hpp"
#include "hal/linux/kernel.hpp"

namespace forager::hal {

// Opens the device by hidapi. Closes the files in `grabs` when it ends, also when it cannot be opened.
[[nodiscard]] Result<std::unique_ptr<HidDevice>> make_hidapi_device(const HidDeviceFacts& facts,
                                                                    Kernel& kernel, std::vector<int> grabs);

}  // namespace forager::hal
