#include "boards/usb_bridges.hpp"

#include <utility>

#include "hal/linux/hid_bus.hpp"

namespace forager::boards {
namespace {

constexpr std::string_view kName = "mcp2221";
constexpr hal::Duration kTimeout = std::chrono::milliseconds(50);

// The bus of a bridge that somebody else owns.
class BridgeI2c final : public hal::I2c {
 public:
  explicit BridgeI2c(hal::I2c& bus) : bus_(&bus) {}

 private:
  hal::Result<> do_transfer(std::uint8_t address, std::span<const std::byte> bytes,
                            std::span<std::byte> into) override {
    if (into.empty()) return bus_->write(address, bytes);
    if (bytes.empty()) return bus_->read(address, into);
    return bus_->write_read(address, bytes, into);
  }
  [[nodiscard]] std::string_view do_name() const override { return bus_->name(); }

  hal::I2c* bus_;
};

}  // namespace

bool UsbBridges::named(std::string_view place) {
  return place == kName || place.rfind(std::string(kName) + ":", 0) == 0;
}

hal::Result<hal::Mcp2221*> UsbBridges::bridge(const std::string& place, hal::Duration timeout) {
  if (hid_ == nullptr) {
    auto opened = hal::open_hid_bus();
    if (!opened) return hal::fail(std::move(opened).error());
    own_hid_ = *std::move(opened);
    hid_ = own_hid_.get();
  }
  hal::Mcp2221Config config{.i2c_timeout = timeout};
  if (place.size() > kName.size()) config.device.serial = place.substr(kName.size() + 1);
  config.device.vendor = hal::mcp2221::kVendor;
  config.device.product = hal::mcp2221::kProduct;
  const auto there = hid_->devices(config.device);
  if (!there) return hal::fail(there.error());
  // With and without its serial number it is the same bridge.
  const std::string path = there->size() == 1 ? there->front().path : std::string();
  if (const auto found = bridges_.find(path); found != bridges_.end()) return found->second.get();
  auto opened = hal::Mcp2221::open(*hid_, config);
  if (!opened) return hal::fail(std::move(opened).error());
  return bridges_.emplace(path, *std::move(opened)).first->second.get();
}

hal::Result<std::unique_ptr<hal::I2c>> UsbBridges::i2c(const std::string& place, hal::Duration timeout) {
  const auto opened = bridge(place, timeout);
  if (!opened) return hal::fail(opened.error());
  return std::make_unique<BridgeI2c>((*opened)->i2c());
}

hal::Result<UsbBridges::Pin> UsbBridges::pin(const std::string& place, const std::string& line) {
  const bool numbered = line.size() == 3 && line.rfind("GP", 0) == 0 && line[2] >= '0' && line[2] <= '3';
  if (!numbered)
    return hal::fail(hal::ErrorCode::invalid_argument, place + "/" + line, "open",
                     "the bridge has no such line", "Its lines are GP0, GP1, GP2 and GP3");
  const auto opened = bridge(place, kTimeout);
  if (!opened) return hal::fail(opened.error());
  return Pin{*opened, static_cast<std::uint8_t>(line[2] - '0')};
}

hal::Result<std::unique_ptr<hal::DigitalOut>> UsbBridges::output(const std::string& place,
                                                                 const std::string& line,
                                                                 hal::Mcp2221Pin wanted) {
  const auto found = pin(place, line);
  if (!found) return hal::fail(found.error());
  wanted.number = found->number;
  return found->bridge->output(wanted);
}

hal::Result<std::unique_ptr<hal::DigitalIn>> UsbBridges::input(const std::string& place,
                                                               const std::string& line, bool active_low) {
  const auto found = pin(place, line);
  if (!found) return hal::fail(found.error());
  return found->bridge->input({.number = found->number, .active_low = active_low});
}

}  // namespace forager::boards
