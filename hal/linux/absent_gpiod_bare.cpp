#include "hal/linux/bare_calls.hpp"

namespace forager::hal {

Result<CallLoop> open_bare_gpio(const std::string& chip, unsigned line) {
  return fail(ErrorCode::unsupported, "gpio " + chip + "/" + std::to_string(line), "open",
              "built without libgpiod", "Install libgpiod-dev and build again with -DFORAGER_WITH_GPIOD=ON");
}

}  // namespace forager::hal
