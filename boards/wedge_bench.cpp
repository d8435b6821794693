#include "boards/wedge_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hal/linux/hid_bus.hpp"
#include "mocks/fake_hid.hpp"
#include "mocks/sim_wedge.hpp"

namespace forager::boards {
namespace {

class RealWedge final : public WedgeBench {
 public:
  explicit RealWedge(std::unique_ptr<hal::Hid> hid) : hid_(std::move(hid)) {}
  hal::Hid& hid() override { return *hid_; }
  void advance(hal::Instant) override {}
  [[nodiscard]] bool emulated() const override { return false; }

 private:
  std::unique_ptr<hal::Hid> hid_;
};

class EmulatedWedge final : public WedgeBench {
 public:
  EmulatedWedge() { hid_.plug(wedge_); }
  hal::Hid& hid() override { return hid_; }
  void advance(hal::Instant now) override {
    constexpr hal::Duration kEvery = std::chrono::milliseconds(500);
    for (; next_ <= now; next_ += kEvery)
      wedge_.read_tag(fmt::format("3034257bf7194e40000000{:02x}", count_++ % 10));
  }
  [[nodiscard]] bool emulated() const override { return true; }

 private:
  mocks::SimWedge wedge_;
  mocks::FakeHid hid_;
  hal::Instant next_{std::chrono::milliseconds(500)};
  int count_ = 0;
};

}  // namespace

hal::Result<std::unique_ptr<WedgeBench>> open_wedge_bench(const BenchWedge& wedge) {
  if (wedge.device.path == "sim") return std::make_unique<EmulatedWedge>();
  auto hid = hal::open_hid_bus();
  if (!hid) return hal::fail(std::move(hid).error());
  return std::make_unique<RealWedge>(*std::move(hid));
}

reader::HidWedgeConfig wedge_config(const BenchWedge& wedge) {
  reader::HidWedgeConfig config{.device = wedge.device, .epc_digits = wedge.epc_digits, .pause = wedge.pause};
  if (config.device.path == "sim") config.device.path.clear();
  config.device = reader::keyboard(config.device);
  return config;
}

hal::Result<BenchWedge> find_wedge(const BenchBoard& board, const std::string& text) {
  std::string there;
  for (const BenchWedge& wedge : board.wedges) {
    if (wedge.name == text) return wedge;
    there += (there.empty() ? "The board file names " : ", ") + wedge.name;
  }
  return hal::fail(hal::ErrorCode::invalid_argument, "wedge '" + text + "'", "find",
                   "there is no reader of this name that types",
                   there.empty() ? "Declare it in the board file: [[wedge]]" : there);
}

}  // namespace forager::boards
