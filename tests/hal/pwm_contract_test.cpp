#include "tests/hal/pwm_contract.hpp"

#include "mocks/fake_pwm.hpp"

namespace forager::hal::contract {
namespace {

class FakeRig final : public PwmRig {
 public:
  PwmGroup& group() override { return group_; }
  PwmChannel& channel(std::size_t index) override { return group_.channel(index); }
  std::optional<Duration> pulse_at_pin(std::size_t index) override { return group_.channel(index).pulse(); }
  Duration period_at_pin() override { return group_.period(); }
  Duration rounding() override { return Duration::zero(); }
  void unplug(bool out) override {
    group_.channel(0).disconnect(out);
    group_.channel(1).disconnect(out);
  }

 private:
  mocks::FakePwmGroup group_{"timer", 2};
};

INSTANTIATE_TEST_SUITE_P(Doubles, PwmContract,
                         testing::Values(PwmRigMaker{"Fake", [] { return std::make_unique<FakeRig>(); }}),
                         [](const auto& rig) { return rig.param.name; });

}  // namespace
}  // namespace forager::hal::contract
