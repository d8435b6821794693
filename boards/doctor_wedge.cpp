// Readers that type as keyboards: whether they are plugged in, and may be opened. No keys are taken from
// whoever has them.
#include <fcntl.h>

#include <string>

#include "boards/doctor.hpp"
#include "boards/wedge_bench.hpp"
#include "hal/linux/kernel.hpp"

namespace forager::boards {
namespace {

constexpr std::string_view kArea = "board";

void check_wedge(const Doctor& doctor, const BenchWedge& wedge) {
  const std::string name = "wedge " + wedge.name;
  if (wedge.device.path == "sim") return doctor.skip(kArea, name, "emulated in this process");
  const auto bench = open_wedge_bench(wedge);
  if (!bench) return doctor.fail(kArea, name, bench.error());
  const auto devices = (*bench)->hid().devices(wedge_config(wedge).device);
  if (!devices) return doctor.fail(kArea, name, devices.error());
  if (devices->empty())
    return doctor.fail(kArea, name, describe(wedge.device) + ": no such device is plugged in",
                       "Check the cable; see what there is: forager hid list");
  const std::string& path = devices->front().path;
  if (devices->size() > 1)
    return doctor.fail(kArea, name, describe(wedge.device) + ": several such devices are plugged in",
                       "Say which in the board file: serial, or path; see forager hid list");
  if (path.empty())
    return doctor.fail(kArea, name, describe(devices->front()) + " has no hidraw node",
                       "A driver of the kernel holds it; see forager hid list");
  const int fd = doctor.kernel.open(path, O_RDWR);
  if (fd >= 0) doctor.kernel.close(fd);
  if (fd < 0 && hal::code_of_device_errno(-fd) == hal::ErrorCode::permission)
    return doctor.fail(kArea, name, path + ": the operating system forbids it [Permission denied]",
                       "Install boards/99-forager.rules into /etc/udev/rules.d; then plug it in again");
  doctor.ok(kArea, name, describe(devices->front()) + " is plugged in");
}

}  // namespace

void check_wedges(const Doctor& doctor, const Board& board) {
  for (const BenchWedge& wedge : board.bench.wedges) check_wedge(doctor, wedge);
}

}  // namespace forager::boards
