#include "tests/hal/hid_contract.hpp"

#include "mocks/fake_hid.hpp"
#include "mocks/sim_hid_echo.hpp"

namespace forager::hal::contract {
namespace {

class FakeRig final : public HidRig {
 public:
  FakeRig() { hid_.plug(echo_); }
  Hid& hid() override { return hid_; }
  void unplug() override { hid_.unplug(echo_); }

 private:
  mocks::SimHidEcho echo_;
  mocks::FakeHid hid_;
};

INSTANTIATE_TEST_SUITE_P(Doubles, HidContract,
                         testing::Values(HidRigMaker{"Fake", [] { return std::make_unique<FakeRig>(); }}),
                         [](const auto& rig) { return rig.param.name; });

}  // namespace
}  // namespace forager::hal::contract
