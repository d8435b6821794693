// A bridge that answers anything: the driver comes to an end and never hands out more bytes than were asked
// for. Input: answers, 64 bytes each; byte 0 of every other one is made that of the question, so that they
// get in.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <utility>

#include "hal/mcp2221.hpp"
#include "mocks/fake_hid.hpp"

namespace {

using namespace forager;

class AnyAnswer final : public mocks::SimHidDevice {
 public:
  explicit AnyAnswer(std::span<const std::uint8_t> bytes) : bytes_(bytes) {
    facts_.vendor = hal::mcp2221::kVendor;
    facts_.product = hal::mcp2221::kProduct;
    facts_.path = "/dev/hidraw0";
  }
  [[nodiscard]] const hal::HidDeviceFacts& facts() const override { return facts_; }
  [[nodiscard]] std::span<const std::uint8_t> report_descriptor() const override { return {}; }
  bool output(std::span<const std::byte> report) override {
    question_ = report[1];
    asked_ = true;
    return true;
  }
  std::size_t input(std::span<std::byte> into) override {
    if (!std::exchange(asked_, false)) return 0;
    const std::size_t count = std::min<std::size_t>(into.size(), bytes_.size());
    std::fill(into.begin(), into.end(), std::byte{0});
    std::transform(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(count), into.begin(),
                   [](std::uint8_t value) { return std::byte{value}; });
    bytes_ = bytes_.subspan(count);
    if (into[0] != std::byte{0xEE}) into[0] = question_;
    return into.size();
  }
  std::optional<std::size_t> get_feature(std::span<std::byte>) override { return std::nullopt; }
  bool set_feature(std::span<const std::byte>) override { return false; }
  void power(bool) override {}

 private:
  hal::HidDeviceFacts facts_;
  std::span<const std::uint8_t> bytes_;
  std::byte question_{};
  bool asked_ = false;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  AnyAnswer device({data, size});
  mocks::FakeHid hid;
  hid.plug(device);
  auto bridge = hal::Mcp2221::open(hid, {.i2c_timeout = std::chrono::milliseconds(5)});
  if (!bridge) return 0;
  if (auto in = (*bridge)->input({.number = 0})) static_cast<void>((*in)->active());
  std::array<std::byte, 130> room{};
  room.fill(std::byte{0xA5});
  const std::span<std::byte> into = std::span(room).first(129);
  static_cast<void>((*bridge)->i2c().write(0x40, into));
  static_cast<void>((*bridge)->i2c().write_read(0x40, std::span(room).first(1), into));
  if (room.back() != std::byte{0xA5}) std::abort();
  return 0;
}
