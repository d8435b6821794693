// The hidapi backend on the kernel's hidraw, with emulated devices plugged in.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "hal/linux/hid_bus.hpp"
#include "hal/mcp2221_wire.hpp"
#include "mocks/sim_hid_echo.hpp"
#include "mocks/sim_i2c_bus.hpp"
#include "mocks/sim_mcp2221.hpp"
#include "mocks/sim_wedge.hpp"
#include "tests/hal/hid_contract.hpp"
#include "tests/kernel/hid_plug.hpp"
#include "tests/kernel/user.hpp"

namespace forager::kernel {
namespace {

using hal::contract::eventually;
using testing::AllOf;
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

// What a user without rights, but in these groups, is told.
std::string opened_by_nobody(const std::vector<std::string>& groups, const hal::HidMatch& match,
                             hal::HidSharing sharing = hal::HidSharing::shared) {
  return as_nobody(groups, [&] {
    const auto hid = hal::open_hid_bus();
    if (!hid) return describe(hid.error());
    const auto device = (*hid)->open(match, sharing);
    return device ? std::string("opened")
                  : std::string(to_string(device.error().code)) + ": " + describe(device.error());
  });
}

TEST(HidOnAKernel, NobodyMayLookButNotOpen) {
  mocks::SimHidEcho echo;
  const HidPlug plug(echo);
  std::string refused;
  EXPECT_TRUE(eventually([&] {
    refused = opened_by_nobody({"plugdev", "input"}, echo_match());
    return refused.starts_with("no permission: hid 1209:0002");
  })) << refused;
  EXPECT_THAT(refused, HasSubstr("99-forager.rules"));
}

TEST(HidOnAKernel, NobodyMayNotAndTheGroupMay) {
  mocks::SimI2cBus wires("wires");
  mocks::SimMcp2221 bridge(wires);
  const HidPlug plug(bridge);
  hal::HidMatch match;
  match.vendor = hal::mcp2221::kVendor;
  match.product = hal::mcp2221::kProduct;
  EXPECT_TRUE(eventually([&] { return opened_by_nobody({"plugdev"}, match) == "opened"; }));
  EXPECT_THAT(opened_by_nobody({}, match), AllOf(HasSubstr("permission: hid 04d8:00dd"),
                                                 HasSubstr("99-forager.rules"), HasSubstr("plugdev")));
}

TEST(HidOnAKernel, TakingAKeyboardAwayNeedsTheGroupOfInputs) {
  mocks::SimWedge keyboard;
  const HidPlug plug(keyboard);
  hal::HidMatch match;
  match.vendor = keyboard.facts().vendor;
  match.product = keyboard.facts().product;
  constexpr auto kAlone = hal::HidSharing::exclusive;
  std::string told;
  EXPECT_TRUE(eventually([&] {
    told = opened_by_nobody({"plugdev", "input"}, match, kAlone);
    return told == "opened";
  })) << told;
  EXPECT_EQ("opened", opened_by_nobody({"plugdev"}, match));
  EXPECT_THAT(opened_by_nobody({"plugdev"}, match, kAlone),
              AllOf(HasSubstr("permission: hid 1209:0004"), HasSubstr("Join the group input")));
}

}  // namespace
}  // namespace forager::kernel

namespace forager::hal::contract {
INSTANTIATE_TEST_SUITE_P(Kernel, HidContract,
                         testing::Values(HidRigMaker{"Hidraw",
                                                     [] { return std::make_unique<kernel::KernelRig>(); }}),
                         [](const auto& rig) { return rig.param.name; });
}  // namespace forager::hal::contract
