#pragma once

#include <string>
#include <string_view>

#include "hal/error.hpp"

namespace forager::hal {

// The portable code of an errno that a socket call left behind. A network that cannot be reached counts as
// disconnected: the cable is out or the address is in another network; refused means the host is there and
// nobody listens.
[[nodiscard]] ErrorCode code_of_socket_errno(int error);

// A Failure with that code, the errno's text, and the mend that fits it best.
[[nodiscard]] Failure socket_failure(std::string_view device, std::string_view operation, int error);

}  // namespace forager::hal
