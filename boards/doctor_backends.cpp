#include <fmt/format.h>

#include <array>

#include "boards/doctor.hpp"

namespace forager::boards {
namespace {

constexpr std::string_view kArea = "backend";

// "CURL:ON:7.88.1,GPIOD:OFF:", from CMake.
constexpr std::string_view kBuiltWith = FORAGER_BACKENDS;

struct Library {
  std::string_view feature;  // FORAGER_WITH_<feature>
  std::string_view name;
  std::string_view gives;
  std::string_view package;
};
constexpr std::array kLibraries{
    Library{"GPIOD", "libgpiod", "GPIO lines", "libgpiod-dev"},
    Library{"LIBUSB", "libusb", "USB devices", "libusb-1.0-0-dev"},
    Library{"HIDAPI", "hidapi", "HID readers and the MCP2221A bridge", "libhidapi-dev"},
    Library{"MODBUS", "libmodbus", "Modbus actuators, gauges and chargers", "libmodbus-dev"},
    Library{"CURL", "libcurl", "readers over HTTP", "libcurl4-openssl-dev"},
    Library{"SQLITE", "sqlite", "inventories that outlive a crash", "libsqlite3-dev"},
    Library{"CRYPTO", "libcrypto", "signed MAVLink", "libssl-dev"},
    Library{"HIGHWAY", "highway", "the fast loops of the simulated air", "libhwy-dev"},
};

struct Built {
  bool have = false;
  std::string_view version;
};
Built built_with(std::string_view feature) {
  for (std::string_view rest = kBuiltWith; !rest.empty();) {
    const std::string_view entry = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), entry.size() + 1));
    const std::size_t first = entry.find(':');
    const std::size_t second = entry.find(':', first + 1);
    if (first == std::string_view::npos || second == std::string_view::npos ||
        entry.substr(0, first) != feature)
      continue;
    return {entry.substr(first + 1, second - first - 1) == "ON", entry.substr(second + 1)};
  }
  return {};
}

}  // namespace

void check_backends(const Doctor& doctor) {
  for (const Library& library : kLibraries) {
    const Built built = built_with(library.feature);
    if (built.have)
      doctor.ok(kArea, std::string(library.name), fmt::format("{}: {}", built.version, library.gives));
    else
      doctor.skip(kArea, std::string(library.name), fmt::format("built without: no {}", library.gives),
                  fmt::format("Install {} and build again with -DFORAGER_WITH_{}=ON", library.package,
                              library.feature));
  }
  // These need nothing but the kernel.
  doctor.ok(kArea, "sysfs pwm", "PWM channels of the kernel");
  doctor.ok(kArea, "i2c-dev", "I2C buses of the kernel");
  doctor.ok(kArea, "termios", "serial ports of the kernel");
}

}  // namespace forager::boards
