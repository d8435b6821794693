#pragma once

#include <memory>

#include "hal/usb_serial.hpp"

namespace forager::hal {

// The serial line of a CDC-ACM device: an autopilot or a microcontroller with USB of its own. `port` counts
// its communication interfaces. Many such devices have no line behind and ignore the rate; what they say they
// took is line(), and another parity, or a rate more than 3 % off, is an error. Errors as UsbSerial;
// unsupported: no communication interface, or one without data; FlowControl::hardware, which this class does
// not have. The bus must outlive the port.
[[nodiscard]] std::unique_ptr<UsbSerial> make_cdc_acm(Usb& usb, const UsbSerialConfig& config);

}  // namespace forager::hal
