#include "tests/hal/byte_stream_contract.hpp"

#include "mocks/faulty_stream.hpp"
#include "mocks/memory_stream.hpp"
#include "tests/hal/usb_serial_rigs.hpp"

namespace forager::hal::contract {
namespace {

class MemoryRig final : public StreamRig {
 public:
  explicit MemoryRig(mocks::MemoryStreamKind kind) : pair_("line", kind) {}
  ByteStream& stream() override { return pair_.near(); }
  ByteStream& peer() override { return pair_.far(); }
  void close_peer() override { pair_.drop(); }
  void refuse_connects(bool refuse) override { pair_.refuse_connects(refuse); }

 private:
  mocks::MemoryStreamPair pair_;
};

class FaultlessRig final : public StreamRig {
 public:
  ByteStream& stream() override { return faultless_; }
  ByteStream& peer() override { return pair_.far(); }
  void close_peer() override { pair_.drop(); }
  void refuse_connects(bool refuse) override { pair_.refuse_connects(refuse); }

 private:
  mocks::MemoryStreamPair pair_{"line", mocks::MemoryStreamKind::bytes};
  mocks::FaultyStream faultless_{pair_.near(), {}, {}, 1};
};

const RigMaker kMemoryBytes{"MemoryBytes",
                            [] { return std::make_unique<MemoryRig>(mocks::MemoryStreamKind::bytes); }};
const RigMaker kMemoryDatagrams{
    "MemoryDatagrams", [] { return std::make_unique<MemoryRig>(mocks::MemoryStreamKind::datagrams); }};
const RigMaker kFaultless{"FaultyStreamWithoutFaults", [] { return std::make_unique<FaultlessRig>(); }};

INSTANTIATE_TEST_SUITE_P(Doubles, ByteStreamContract,
                         testing::Values(kMemoryBytes, kMemoryDatagrams, kFaultless), rig_name);
INSTANTIATE_TEST_SUITE_P(Doubles, OrderedContract, testing::Values(kMemoryBytes, kFaultless), rig_name);
INSTANTIATE_TEST_SUITE_P(Doubles, ConnectionContract, testing::Values(kMemoryBytes, kFaultless), rig_name);
INSTANTIATE_TEST_SUITE_P(UsbSerial, ByteStreamContract, testing::Values(kCdcAcm, kFtdi), rig_name);
INSTANTIATE_TEST_SUITE_P(UsbSerial, OrderedContract, testing::Values(kCdcAcm, kFtdi), rig_name);
INSTANTIATE_TEST_SUITE_P(Doubles, DatagramContract, testing::Values(kMemoryDatagrams), rig_name);

}  // namespace
}  // namespace forager::hal::contract
