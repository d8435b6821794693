#include "boards/plug_bench.hpp"

#include <array>
#include <cstddef>
#include <utility>

#include "hal/linux/hid_bus.hpp"
#include "hal/linux/usb_bus.hpp"
#include "mocks/fake_hid.hpp"
#include "mocks/fake_usb.hpp"
#include "mocks/sim_hid_echo.hpp"
#include "mocks/sim_usb_echo.hpp"

namespace forager::boards {
namespace {

using namespace std::chrono_literals;

template <class Bus>
hal::Result<Bus*> once(std::unique_ptr<Bus>& bus, hal::Result<std::unique_ptr<Bus>> (*open)()) {
  if (!bus) {
    auto opened = open();
    if (!opened) return hal::fail(std::move(opened).error());
    bus = *std::move(opened);
  }
  return bus.get();
}

class RealPlugs final : public PlugBench {
 public:
  hal::Result<hal::Usb*> usb() override {
    return once<hal::Usb>(usb_, [] { return hal::open_usb_bus(); });
  }
  hal::Result<hal::Hid*> hid() override {
    return once<hal::Hid>(hid_, [] { return hal::open_hid_bus(); });
  }
  void advance(hal::Instant /*now*/) override {}

 private:
  std::unique_ptr<hal::Usb> usb_;
  std::unique_ptr<hal::Hid> hid_;
};

class EmulatedPlugs final : public PlugBench {
 public:
  EmulatedPlugs() {
    usb_.plug(first_);
    hid_.plug(echo_);
  }
  hal::Result<hal::Usb*> usb() override { return &usb_; }
  hal::Result<hal::Hid*> hid() override { return &hid_; }

  void advance(hal::Instant now) override {
    if (next_ == 0 && now >= hal::Instant(1s)) {
      usb_.plug(second_, false);
      std::array<std::byte, 65> report{};  // its number, none, and 64 bytes
      report[1] = std::byte{'h'};
      report[2] = std::byte{'i'};
      echo_.output(report);
      ++next_;
    }
    if (next_ == 1 && now >= hal::Instant(2s)) {
      usb_.unplug(second_);
      ++next_;
    }
  }

 private:
  mocks::SimUsbEcho first_;
  mocks::SimUsbEcho second_{"1-2", "SN43"};
  mocks::SimHidEcho echo_;
  mocks::FakeUsb usb_;
  mocks::FakeHid hid_;
  int next_ = 0;
};

}  // namespace

std::unique_ptr<PlugBench> real_plugs() { return std::make_unique<RealPlugs>(); }
std::unique_ptr<PlugBench> emulated_plugs() { return std::make_unique<EmulatedPlugs>(); }

}  // namespace forager::boards
