// The drive loop moves real lines of a kernel, and the emulated vehicle is braked by what they say.
#include "tests/boards/brakes/drive_contract.hpp"
#include "tests/kernel/gpio_sim.hpp"

namespace forager::boards {
namespace {

class SimLines final : public DriveLines {
 public:
  bool level(unsigned line) override { return sim_.level(line); }
  void press_stop() override { sim_.drive(2, true); }

 private:
  kernel::GpioSim sim_{kDriveChip, {{"BRAKE_LEFT"}, {"BRAKE_RIGHT"}, {"STOP"}}};
};

INSTANTIATE_TEST_SUITE_P(Kernel, DriveOverGpio,
                         testing::Values(DriveLinesMaker{"GpioSim",
                                                         [] { return std::make_unique<SimLines>(); }}),
                         [](const auto& lines) { return lines.param.name; });

}  // namespace
}  // namespace forager::boards
