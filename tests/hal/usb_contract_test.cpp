#include "tests/hal/usb_contract.hpp"

#include "mocks/fake_usb.hpp"
#include "mocks/sim_usb_echo.hpp"

namespace forager::hal::contract {
namespace {

class FakeRig final : public UsbRig {
 public:
  FakeRig() { usb_.plug(echo_); }
  Usb& usb() override { return usb_; }
  void unplug() override { usb_.unplug(echo_); }
  void plug() override { usb_.plug(echo_); }

 private:
  mocks::SimUsbEcho echo_;
  mocks::FakeUsb usb_;
};

INSTANTIATE_TEST_SUITE_P(Doubles, UsbContract,
                         testing::Values(UsbRigMaker{"Fake", [] { return std::make_unique<FakeRig>(); }}),
                         [](const auto& rig) { return rig.param.name; });

}  // namespace
}  // namespace forager::hal::contract
