#include "hal/mcp2221.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "hal/mcp2221_bus.hpp"

namespace forager::hal {

using namespace mcp2221;

namespace {

std::uint8_t byte_at(std::span<const std::byte> report, std::size_t at) {
  return std::to_integer<std::uint8_t>(report[at]);
}

}  // namespace

Mcp2221::Mcp2221(std::unique_ptr<HidDevice> device, const Mcp2221Config& config)
    : device_(std::move(device)), config_(config) {
  const HidDeviceFacts& facts = device_->facts();
  name_ = "mcp2221 " + (facts.serial.empty() ? facts.path : facts.serial);
}

Mcp2221::~Mcp2221() = default;

Result<std::unique_ptr<Mcp2221>> Mcp2221::open(Hid& hid, const Mcp2221Config& config) {
  constexpr std::uint32_t kFastest =
      400'000;  // I2C-bus specification UM10204: fast mode, as far as the chip goes
  constexpr std::uint32_t kSlowest = kClockHz / (255 + kDividerOffset) + 1;
  if (config.i2c_hz < kSlowest || config.i2c_hz > kFastest)
    return fail(ErrorCode::invalid_argument, "mcp2221", "open",
                fmt::format("{} Hz on I2C: from {} to {} are possible", config.i2c_hz, kSlowest, kFastest));
  HidMatch match = config.device;
  match.vendor = kVendor;
  match.product = kProduct;
  auto device = hid.open(match);
  if (!device) return fail(std::move(device).error());
  std::unique_ptr<Mcp2221> bridge(new Mcp2221(*std::move(device), config));
  FORAGER_TRY(bridge->start());
  return bridge;
}

Result<Mcp2221::Report> Mcp2221::exchange(const Report& request, std::string_view operation) {
  constexpr int kMostStale = 64;  // what the kernel keeps unread
  Report answer{};
  // The answer to a question that was given up must not be taken for the next one's.
  for (int i = 0; i < kMostStale; ++i) {
    const auto stale = device_->poll(answer);
    if (!stale) return fail(stale.error());
    if (*stale == 0) break;
  }
  std::array<std::byte, kReportBytes + 1> numbered{};  // the chip's reports have no number: 0
  std::copy(request.begin(), request.end(), numbered.begin() + 1);
  if (auto written = device_->write(numbered); !written) return fail(std::move(written).error());
  const auto got = device_->read(answer, config_.reply);
  if (!got) return fail(got.error());
  if (*got != kReportBytes || answer[0] != request[0])
    return fail(ErrorCode::protocol, name_, std::string(operation),
                fmt::format("{} bytes answer command 0x{:02x} with 0x{:02x}", *got, byte_at(request, 0),
                            byte_at(answer, 0)),
                "Unplug the bridge and plug it in again");
  return answer;
}

Result<> Mcp2221::start() {
  Report request{};
  request[0] = std::byte{kStatus};
  request[kCancelAt] = std::byte{kCancel};  // what a program before this one left half done
  auto status = exchange(request, "cancel");
  if (!status) return fail(status.error());
  const auto letter = [&](std::size_t i) { return static_cast<char>(byte_at(*status, kHardwareAt + i)); };
  version_ = fmt::format("hardware {}{}, firmware {}{}", letter(0), letter(1), letter(2), letter(3));
  request[kCancelAt] = std::byte{0};
  request[kSetSpeedAt] = std::byte{kSetSpeed};
  // Rounded up, so that the bus is never faster than asked.
  const std::uint32_t divider = (kClockHz + config_.i2c_hz - 1) / config_.i2c_hz - kDividerOffset;
  request[kDividerAt] = static_cast<std::byte>(divider);
  status = exchange(request, "set the speed of I2C");
  if (!status) return fail(status.error());
  if (byte_at(*status, kSetSpeedAt) != kSetSpeed)
    return fail(ErrorCode::busy, name_, "set the speed of I2C", "a transfer does not end",
                "A chip may hold SCL or SDA low: take the bus apart, or unplug the bridge");
  Report ask{};
  ask[0] = std::byte{kGetSram};
  const auto sram = exchange(ask, "read settings");
  if (!sram) return fail(sram.error());
  for (std::size_t pin = 0; pin < kPins; ++pin) pins_[pin] = byte_at(*sram, kGetPinsAt + pin);
  bus_ = std::make_unique<Mcp2221Bus>(
      "i2c " + name_,
      [this](const Report& out, std::string_view operation) { return exchange(out, operation); },
      config_.i2c_timeout);
  return {};
}

I2c& Mcp2221::i2c() { return *bus_; }

}  // namespace forager::hal
