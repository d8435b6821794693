#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "hal/modbus.hpp"

namespace forager::mocks {

// A bus with one device on it, whose registers a test can look at. Only declared ones exist: others are
// answered with exception 2, other units with silence.
class FakeModbus final : public hal::Modbus {
 public:
  explicit FakeModbus(std::uint8_t unit = 1) : unit_(unit) {}

  std::map<std::uint16_t, std::uint16_t> holding;
  std::map<std::uint16_t, std::uint16_t> input;
  std::map<std::uint16_t, bool> coils;
  std::uint32_t requests = 0;  // that were let through
  void fail_next(hal::Error error) { next_error_ = std::move(error); }
  void disconnect(bool out = true) { disconnected_ = out; }

 private:
  hal::Result<> do_read(Table table, std::uint8_t unit, std::uint16_t address,
                        std::span<std::uint16_t> into) override;
  hal::Result<> do_write(std::uint8_t unit, std::uint16_t address,
                         std::span<const std::uint16_t> values) override;
  hal::Result<> do_write_coil(std::uint8_t unit, std::uint16_t address, bool on) override;
  [[nodiscard]] std::string_view do_name() const override { return "modbus fake"; }
  hal::Result<> admit(std::uint8_t unit, std::string_view operation);

  std::uint8_t unit_;
  bool disconnected_ = false;
  std::optional<hal::Error> next_error_;
};

}  // namespace forager::mocks
