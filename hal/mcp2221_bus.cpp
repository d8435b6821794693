#include "hal/mcp2221_bus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace forager::hal {

using namespace mcp2221;

namespace {

std::uint8_t byte_at(std::span<const std::byte> report, std::size_t at) {
  return std::to_integer<std::uint8_t>(report[at]);
}

Mcp2221Bus::Report request_of(std::uint8_t command, std::size_t length, unsigned address) {
  Mcp2221Bus::Report request{};
  request[0] = std::byte{command};
  request[1] = static_cast<std::byte>(length & 0xFFU);
  request[2] = static_cast<std::byte>(length >> 8U);
  request[3] = static_cast<std::byte>(address);
  return request;
}

}  // namespace

Mcp2221Bus::Mcp2221Bus(std::string name, Exchange exchange, Duration timeout)
    : name_(std::move(name)),
      exchange_(std::move(exchange)),
      questions_(
          static_cast<int>(std::clamp<std::int64_t>(timeout / std::chrono::milliseconds(1), 1, 10'000))) {}

Failure Mcp2221Bus::too_long() const {
  return failed(ErrorCode::timeout, "the transfer does not end",
                "A chip may hold SCL or SDA low; check the pull-up resistors");
}

// Numbers of the engine: hid-mcp2221 of Linux.
Result<> Mcp2221Bus::judge(std::uint8_t engine) const {
  switch (engine) {
    case kAddressRefused:
    case kAddressSent:
      return failed(ErrorCode::no_ack, "no chip answers at this address",
                    "Check power, address straps, and that SDA and SCL are not swapped");
    case kStartTimeout:
    case kRepeatedStartTimeout:
    case kAddressTimeout:
    case kDataTimeout:
    case kStopTimeout:
      return failed(ErrorCode::timeout, fmt::format("the bus hangs (engine 0x{:02x})", engine),
                    "A chip may hold SCL or SDA low; check the pull-up resistors");
    default:
      return {};
  }
}

void Mcp2221Bus::cancel() {
  Report request{};
  request[0] = std::byte{kStatus};
  request[kCancelAt] = std::byte{kCancel};
  static_cast<void>(exchange_(request, "cancel"));
}

Result<> Mcp2221Bus::hand_over(const Report& request) {
  for (int i = 0; i < questions_; ++i) {
    const auto answer = exchange_(request, operation_);
    if (!answer) return fail(answer.error());
    if (byte_at(*answer, 1) == kDone) return {};
    FORAGER_TRY(judge(byte_at(*answer, 2)));
  }
  return failed(ErrorCode::busy, "the bridge is busy with an earlier transfer");
}

Result<> Mcp2221Bus::wait_sent(std::uint8_t end) {
  Report request{};
  request[0] = std::byte{kStatus};
  for (int i = 0; i < questions_; ++i) {
    const auto status = exchange_(request, operation_);
    if (!status) return fail(status.error());
    if ((byte_at(*status, kAcknowledgeAt) & kNotAcknowledged) != 0) return judge(kAddressRefused);
    const std::uint8_t engine = byte_at(*status, kEngineAt);
    FORAGER_TRY(judge(engine));
    if (engine == end) return {};
  }
  return too_long();
}

Result<> Mcp2221Bus::send(std::uint8_t command, std::uint8_t address, std::span<const std::byte> bytes) {
  Report request = request_of(command, bytes.size(), static_cast<unsigned>(address) << 1U);
  for (std::size_t sent = 0; sent < bytes.size(); sent += kDataBytes) {
    const auto piece = bytes.subspan(sent, std::min(kDataBytes, bytes.size() - sent));
    std::copy(piece.begin(), piece.end(), request.begin() + kDataAt);
    FORAGER_TRY(hand_over(request));
  }
  return wait_sent(command == kWriteNoStop ? kNoStopDone : kIdle);
}

// Bytes of the engine that came by now; 0: none yet.
Result<std::size_t> Mcp2221Bus::fetch(std::span<std::byte> into) {
  Report request{};
  request[0] = std::byte{kReadData};
  const auto answer = exchange_(request, operation_);
  if (!answer) return fail(answer.error());
  if (auto judged = judge(byte_at(*answer, 2)); !judged) return fail(std::move(judged).error());
  const std::uint8_t count = byte_at(*answer, 3);
  const std::uint8_t engine = byte_at(*answer, 2);
  const bool there = engine == kReadComplete || engine == kReadPartial;
  if (byte_at(*answer, 1) != kDone || count == kReadFailed || !there) return std::size_t{0};
  if (count > kDataBytes || count > into.size())
    return failed(ErrorCode::protocol, fmt::format("{} bytes came where {} were left", count, into.size()));
  std::copy_n(answer->begin() + kDataAt, count, into.begin());
  return std::size_t{count};
}

Result<> Mcp2221Bus::receive(std::uint8_t command, std::uint8_t address, std::span<std::byte> into) {
  FORAGER_TRY(hand_over(request_of(command, into.size(), static_cast<unsigned>(address) << 1U | 1U)));
  int left = questions_;
  while (!into.empty()) {
    const auto got = fetch(into);
    if (!got) return fail(got.error());
    into = into.subspan(*got);
    if (*got == 0 && --left == 0) return too_long();
  }
  return {};
}

Result<> Mcp2221Bus::run(std::uint8_t address, std::span<const std::byte> bytes, std::span<std::byte> into) {
  if (into.empty()) return send(kWrite, address, bytes);
  if (bytes.empty()) return receive(kRead, address, into);
  FORAGER_TRY(send(kWriteNoStop, address, bytes));
  return receive(kReadRepeatedStart, address, into);
}

Result<> Mcp2221Bus::do_transfer(std::uint8_t address, std::span<const std::byte> bytes,
                                 std::span<std::byte> into) {
  operation_ = fmt::format("transfer with 0x{:02x}", address);
  auto done = run(address, bytes, into);
  if (!done && done.error().code != ErrorCode::disconnected) cancel();
  return done;
}

}  // namespace forager::hal
