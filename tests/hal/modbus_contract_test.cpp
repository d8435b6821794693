#include "tests/hal/modbus_contract.hpp"

#include "mocks/fake_modbus.hpp"

namespace forager::hal::contract {
namespace {

class FakeRig final : public ModbusRig {
 public:
  FakeRig() {
    for (std::uint16_t i = 10; i < 20; ++i) bus_.holding[i] = 0;
    bus_.input = {{20, 0x1234}, {21, 0xFFFE}};
    bus_.coils[3] = false;
  }
  Modbus& bus() override { return bus_; }
  std::uint16_t holding(std::uint16_t address) override { return bus_.holding.at(address); }
  bool coil(std::uint16_t address) override { return bus_.coils.at(address); }
  void unplug() override { bus_.disconnect(); }

 private:
  mocks::FakeModbus bus_{7};
};

INSTANTIATE_TEST_SUITE_P(Doubles, ModbusContract,
                         testing::Values(ModbusRigMaker{"Fake", [] { return std::make_unique<FakeRig>(); }}),
                         [](const auto& rig) { return rig.param.name; });

}  // namespace
}  // namespace forager::hal::contract
