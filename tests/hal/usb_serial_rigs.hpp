#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "hal/cdc_acm.hpp"
#include "hal/ftdi.hpp"
#include "mocks/fake_usb.hpp"
#include "mocks/memory_stream.hpp"
#include "mocks/sim_cdc_acm.hpp"
#include "mocks/sim_ftdi.hpp"
#include "tests/hal/byte_stream_rig.hpp"

// USB serial adapters for the contract of hal::ByteStream.
namespace forager::hal::contract {

// An adapter with a device at the other end of its line. The far end hears of the host by DTR; the host hears
// of the far end only by its bytes, so "the other end hangs up" is somebody pulling the adapter.
template <class Adapter>
class AdapterRig final : public StreamRig {
 public:
  explicit AdapterRig(std::function<std::unique_ptr<SerialPort>(Usb&)> make) : port_(make(usb_)) {
    usb_.plug(adapter_);
  }
  ByteStream& stream() override { return *port_; }
  ByteStream& peer() override { return line_.far(); }
  void close_peer() override {
    usb_.unplug(adapter_);
    usb_.plug(adapter_);
  }
  void refuse_connects(bool) override {}

 private:
  mocks::MemoryStreamPair line_{"rs232", mocks::MemoryStreamKind::bytes};
  Adapter adapter_{line_.near()};
  mocks::FakeUsb usb_;
  std::unique_ptr<SerialPort> port_;
};

inline const RigMaker kCdcAcm{
    "CdcAcm", [] {
      return std::make_unique<AdapterRig<mocks::SimCdcAcm>>([](Usb& usb) { return make_cdc_acm(usb, {}); });
    }};
inline const RigMaker kFtdi{
    "Ftdi",
    [] { return std::make_unique<AdapterRig<mocks::SimFtdi>>([](Usb& usb) { return make_ftdi(usb, {}); }); }};

}  // namespace forager::hal::contract
