#pragma once

#include <string>

#include "mocks/recording_bus.hpp"
#include "mocks/replay.hpp"

namespace forager::mocks {

// Buses as mocks/recording_bus.hpp noted them; `name` is that of the recorded one.

class ReplayI2c final : public hal::I2c {
 public:
  ReplayI2c(std::string name, Replay& replay) : name_(std::move(name)), replay_(&replay) {}

 private:
  hal::Result<> do_transfer(std::uint8_t address, std::span<const std::byte> bytes,
                            std::span<std::byte> into) override {
    const auto answer =
        replay_->call(name_, "transfer", {hal::field(address), hal::field(bytes), hal::field(into.size())});
    if (!answer) return hal::fail(answer.error());
    if (answer->size() != 1 || copied(answer->front(), into) != into.size())
      return Replay::broken(name_, "transfer");
    return {};
  }
  [[nodiscard]] std::string_view do_name() const override { return name_; }
  std::string name_;
  Replay* replay_;
};

class ReplayModbus final : public hal::Modbus {
 public:
  ReplayModbus(std::string name, Replay& replay) : name_(std::move(name)), replay_(&replay) {}

 private:
  hal::Result<> do_read(Table table, std::uint8_t unit, std::uint16_t address,
                        std::span<std::uint16_t> into) override {
    const std::string_view operation = RecordingModbus::read_name(table == Table::holding);
    const auto answer =
        replay_->call(name_, operation, {hal::field(unit), hal::field(address), hal::field(into.size())});
    if (!answer) return hal::fail(answer.error());
    if (answer->size() != into.size()) return Replay::broken(name_, operation);
    for (std::size_t i = 0; i < into.size(); ++i) {
      const auto value = hal::integer_in((*answer)[i]);
      if (!value || *value < 0 || *value > 65535) return Replay::broken(name_, operation);
      into[i] = static_cast<std::uint16_t>(*value);
    }
    return {};
  }
  hal::Result<> do_write(std::uint8_t unit, std::uint16_t address,
                         std::span<const std::uint16_t> values) override {
    return nothing_of(
        replay_->call(name_, "write_holding", RecordingModbus::fields_of(unit, address, values)));
  }
  hal::Result<> do_write_coil(std::uint8_t unit, std::uint16_t address, bool on) override {
    return nothing_of(
        replay_->call(name_, "write_coil", {hal::field(unit), hal::field(address), hal::field(on)}));
  }
  [[nodiscard]] std::string_view do_name() const override { return name_; }
  std::string name_;
  Replay* replay_;
};

}  // namespace forager::mocks
