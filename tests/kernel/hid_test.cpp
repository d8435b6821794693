// The hidapi backend on the kernel's hidraw, with emulated devices plugged in.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "hal/linux/hid_bus.hpp"
#include "mocks/sim_hid_echo.hpp"
#include "tests/hal/hid_contract.hpp"
#include "tests/kernel/hid_plug.hpp"
#include "tests/kernel/user.hpp"

namespace forager::kernel {
namespace {

using hal::contract::eventually;
using testing::HasSubstr;

hal::HidMatch echo_match() {
  hal::HidMatch match;
  match.vendor = 0x1209;
  match.product = 0x0002;
  return match;
}

class KernelRig final : public hal::contract::HidRig {
 public:
  KernelRig() {
    EXPECT_TRUE(eventually([&] { return hid_->open(echo_match()).has_value(); }));
  }
  hal::Hid& hid() override { return *hid_; }
  void unplug() override { plug_.reset(); }

 private:
  mocks::SimHidEcho echo_;
  std::unique_ptr<hal::Hid> hid_ = hal::open_hid_bus().value();
  std::optional<HidPlug> plug_{std::in_place, echo_};
};

TEST(HidOnAKernel, NobodyMayLookButNotOpen) {
  mocks::SimHidEcho echo;
  const HidPlug plug(echo);
  const auto try_it = [] {
    const auto hid = hal::open_hid_bus();
    if (!hid) return describe(hid.error());
    const auto device = (*hid)->open(echo_match());
    return device ? std::string("opened")
                  : std::string(to_string(device.error().code)) + ": " + describe(device.error());
  };
  std::string refused;
  EXPECT_TRUE(eventually([&] {
    refused = as_nobody({}, try_it);
    return refused.starts_with("no permission: hid 1209:0002");
  })) << refused;
  EXPECT_THAT(refused, HasSubstr("99-forager.rules"));
}

}  // namespace
}  // namespace forager::kernel

namespace forager::hal::contract {
INSTANTIATE_TEST_SUITE_P(Kernel, HidContract,
                         testing::Values(HidRigMaker{"Hidraw",
                                                     [] { return std::make_unique<kernel::KernelRig>(); }}),
                         [](const auto& rig) { return rig.param.name; });
}  // namespace forager::hal::contract
