#include "hal/linux/hid_bus.hpp"

namespace forager::hal {

Result<std::unique_ptr<Hid>> open_hid_bus(Kernel&) {
  return fail(ErrorCode::unsupported, "hid", "open", "built without hidapi",
              "Install libhidapi-dev and build again with -DFORAGER_WITH_HIDAPI=ON");
}

std::string hid_library() { return "built without hidapi"; }

}  // namespace forager::hal
