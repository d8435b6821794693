#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "hal/i2c.hpp"
#include "hal/mcp2221_wire.hpp"
#include "hal/time.hpp"

namespace forager::hal {

// The I2C engine of an MCP2221A; made by Mcp2221 only. A transfer is handed to the engine in reports, and
// then asked about until it has ended; every question takes a frame of USB at least, so that the number of
// questions bounds the time. After an error the engine is told to let go of the bus.
class Mcp2221Bus final : public I2c {
 public:
  using Report = std::array<std::byte, mcp2221::kReportBytes>;
  using Exchange = std::function<Result<Report>(const Report& request, std::string_view operation)>;

  Mcp2221Bus(std::string name, Exchange exchange, Duration timeout);

 private:
  Result<> do_transfer(std::uint8_t address, std::span<const std::byte> bytes,
                       std::span<std::byte> into) override;
  [[nodiscard]] std::string_view do_name() const override { return name_; }

  Result<> run(std::uint8_t address, std::span<const std::byte> bytes, std::span<std::byte> into);
  // Hands a report to the engine, again and again while it is busy with the one before.
  Result<> hand_over(const Report& request);
  Result<> send(std::uint8_t command, std::uint8_t address, std::span<const std::byte> bytes);
  Result<> wait_sent(std::uint8_t end);  // until the engine is in this state
  Result<> receive(std::uint8_t command, std::uint8_t address, std::span<std::byte> into);
  Result<std::size_t> fetch(std::span<std::byte> into);
  void cancel();
  [[nodiscard]] Failure failed(ErrorCode code, std::string detail, std::string mend = {}) const {
    return fail(code, name_, operation_, std::move(detail), std::move(mend));
  }
  [[nodiscard]] Result<> judge(std::uint8_t engine) const;  // errors only
  [[nodiscard]] Failure too_long() const;

  std::string name_;
  Exchange exchange_;
  int questions_;
  std::string operation_;
};

}  // namespace forager::hal
