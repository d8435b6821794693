// The four pins of an MCP2221A.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hal/mcp2221.hpp"

namespace forager::hal {

using namespace mcp2221;

namespace {

constexpr std::size_t kSetBytes = 4;  // of one pin in kSetGpio
constexpr std::size_t kGetBytes = 2;  // and in the answer of kGetGpio

}  // namespace

Mcp2221::Lease::Lease(Mcp2221& bridge, std::vector<Mcp2221Pin> pins)
    : bridge_(&bridge), pins_(std::move(pins)), name_(bridge.name()) {
  for (const Mcp2221Pin& pin : pins_) {
    name_ += fmt::format("{}GP{}", &pin == pins_.data() ? " " : "+", pin.number);
    bridge_->taken_.at(pin.number) = true;
  }
}

Mcp2221::Lease::Lease(Lease&& other) noexcept
    : bridge_(std::exchange(other.bridge_, nullptr)),
      pins_(std::move(other.pins_)),
      name_(std::move(other.name_)) {}

Mcp2221::Lease::~Lease() {
  if (bridge_ == nullptr) return;
  for (const Mcp2221Pin& pin : pins_) bridge_->taken_.at(pin.number) = false;
}

void Mcp2221::Lease::end_inactive() {
  const bool keep = bridge_ == nullptr || std::any_of(pins_.begin(), pins_.end(),
                                                      [](const Mcp2221Pin& pin) { return pin.keep_at_end; });
  constexpr std::array<bool, kPins> kInactive{};
  if (!keep) static_cast<void>(bridge_->set_pins(*this, std::span(kInactive).first(pins_.size())));
}

Result<Mcp2221::Lease> Mcp2221::lease(std::span<const Mcp2221Pin> wanted, bool input) {
  const auto refuse = [&](ErrorCode code, std::string why) {
    return fail(code, name_, "open a pin", std::move(why));
  };
  if (wanted.empty() || wanted.size() > kPins)
    return refuse(ErrorCode::invalid_argument,
                  fmt::format("{} pins of a chip that has {}", wanted.size(), kPins));
  std::array<bool, kPins> seen = taken_;
  auto pins = pins_;
  for (const Mcp2221Pin& pin : wanted) {
    if (pin.number >= kPins)
      return refuse(ErrorCode::invalid_argument, fmt::format("GP{}: the chip has GP0 to GP3", pin.number));
    if (seen.at(pin.number)) return refuse(ErrorCode::busy, fmt::format("GP{} is in use", pin.number));
    seen.at(pin.number) = true;
    pins.at(pin.number) = input ? kPinInput : pin.begin_active != pin.active_low ? kPinHigh : std::uint8_t{0};
  }
  // Use, direction and level in one report: no spike. The other pins are told what they do now.
  Report request{};
  request[0] = std::byte{kSetSram};
  request[kAlterPinsAt] = std::byte{kAlterPins};
  for (std::size_t i = 0; i < kPins; ++i) request[kSetPinsAt + i] = std::byte{pins.at(i)};
  const auto answer = exchange(request, "open a pin");
  if (!answer) return fail(answer.error());
  if (std::to_integer<std::uint8_t>((*answer)[1]) != kDone)
    return refuse(ErrorCode::refused, "the chip does not take the settings");
  pins_ = pins;
  return Lease(*this, {wanted.begin(), wanted.end()});
}

Result<> Mcp2221::set_pins(const Lease& lease, std::span<const bool> active) {
  Report request{};
  request[0] = std::byte{kSetGpio};
  auto pins = pins_;
  for (std::size_t i = 0; i < lease.pins().size(); ++i) {
    const Mcp2221Pin& pin = lease.pins()[i];
    const bool high = active[i] != pin.active_low;
    const std::size_t at = kPinAt + kSetBytes * pin.number;
    request.at(at) = std::byte{1};
    request.at(at + 1) = std::byte{high};
    pins.at(pin.number) = high ? kPinHigh : std::uint8_t{0};
  }
  const auto answer = exchange(request, "set");
  if (!answer) return fail(answer.error());
  for (const Mcp2221Pin& pin : lease.pins())
    if ((*answer).at(kPinAt + kSetBytes * pin.number) == std::byte{kNotGpioLevel})
      return fail(ErrorCode::io, lease.name(), "set",
                  fmt::format("GP{} is no GPIO any more: the bridge was reset", pin.number),
                  "Check the USB cable and supply, and start again");
  pins_ = pins;
  return {};
}

Result<bool> Mcp2221::pin_active(const Lease& lease) {
  Report request{};
  request[0] = std::byte{kGetGpio};
  const auto answer = exchange(request, "read");
  if (!answer) return fail(answer.error());
  const Mcp2221Pin& pin = lease.pins().front();
  const auto level = std::to_integer<std::uint8_t>((*answer).at(kPinAt + kGetBytes * pin.number));
  if (level > 1)
    return fail(ErrorCode::io, lease.name(), "read",
                fmt::format("GP{} is no GPIO any more: the bridge was reset", pin.number),
                "Check the USB cable and supply, and start again");
  return (level == 1) != pin.active_low;
}

class Mcp2221::Out final : public DigitalOut {
 public:
  explicit Out(Lease lease) : lease_(std::move(lease)) {}
  ~Out() override { lease_.end_inactive(); }
  Out(const Out&) = delete;
  Out& operator=(const Out&) = delete;

 private:
  Result<> do_set(bool active) override {
    const std::array<bool, 1> level{active};
    return lease_.bridge().set_pins(lease_, level);
  }
  [[nodiscard]] std::string_view do_name() const override { return lease_.name(); }
  Lease lease_;
};

class Mcp2221::In final : public DigitalIn {
 public:
  explicit In(Lease lease) : lease_(std::move(lease)) {}

 private:
  Result<bool> do_active() override { return lease_.bridge().pin_active(lease_); }
  [[nodiscard]] std::string_view do_name() const override { return lease_.name(); }
  Lease lease_;
};

class Mcp2221::Group final : public DigitalOutGroup {
 public:
  explicit Group(Lease lease) : lease_(std::move(lease)) {}
  ~Group() override { lease_.end_inactive(); }
  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;

 private:
  Result<> do_set(std::span<const bool> active) override { return lease_.bridge().set_pins(lease_, active); }
  [[nodiscard]] std::size_t do_size() const override { return lease_.pins().size(); }
  [[nodiscard]] std::string_view do_name() const override { return lease_.name(); }
  Lease lease_;
};

Result<std::unique_ptr<DigitalOut>> Mcp2221::output(const Mcp2221Pin& pin) {
  return lease({&pin, 1}, false).map([](Lease&& lease) -> std::unique_ptr<DigitalOut> {
    return std::make_unique<Out>(std::move(lease));
  });
}

Result<std::unique_ptr<DigitalIn>> Mcp2221::input(const Mcp2221Pin& pin) {
  return lease({&pin, 1}, true).map([](Lease&& lease) -> std::unique_ptr<DigitalIn> {
    return std::make_unique<In>(std::move(lease));
  });
}

Result<std::unique_ptr<DigitalOutGroup>> Mcp2221::outputs(std::span<const Mcp2221Pin> pins) {
  return lease(pins, false).map([](Lease&& lease) -> std::unique_ptr<DigitalOutGroup> {
    return std::make_unique<Group>(std::move(lease));
  });
}

}  // namespace forager::hal
