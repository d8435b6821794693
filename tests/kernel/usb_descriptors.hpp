#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hal/usb_facts.hpp"

namespace forager::kernel {

// What a device of these facts answers to GET_DESCRIPTOR (USB 2.0, section 9.4.3); nothing: it has none.
// `kind` and `index` are the two halves of wValue.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> usb_descriptor(const hal::UsbDeviceFacts& facts,
                                                                      std::uint8_t kind, std::uint8_t index);

}  // namespace forager::kernel
