#include "tests/hal/digital_contract.hpp"

#include "mocks/fake_digital_in.hpp"
#include "mocks/fake_digital_out.hpp"

namespace forager::hal::contract {
namespace {

class FakeRig final : public DigitalRig {
 public:
  DigitalOut& out() override { return out_; }
  bool out_is_active() override { return out_.active(); }
  EdgeIn& in() override { return in_; }
  void drive_in(bool active, Instant at) override { in_.drive(active, at); }
  void unplug(bool out) override {
    out_.disconnect(out);
    in_.disconnect(out);
  }

 private:
  mocks::FakeDigitalOut out_{"out"};
  mocks::FakeDigitalIn in_{"in"};
};

INSTANTIATE_TEST_SUITE_P(Doubles, DigitalContract,
                         testing::Values(DigitalRigMaker{"Fake", [] { return std::make_unique<FakeRig>(); }}),
                         [](const auto& rig) { return rig.param.name; });

}  // namespace
}  // namespace forager::hal::contract
