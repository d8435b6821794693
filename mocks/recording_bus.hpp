#pragma once

#include "hal/i2c.hpp"
#include "hal/modbus.hpp"
#include "mocks/recording_fields.hpp"

namespace forager::mocks {

// Buses on which somebody answers; borrow the bus.
//   transfer 64 06 2 = ok 1e00      I2C: address, bytes out, how many in; bytes in
//   read_holding 7 10 2 = ok 4660 22136      Modbus: unit, register, how many; values
//   read_input 7 20 1 = ok 5
//   write_holding 7 10 4660 22136 = ok
//   write_coil 7 3 1 = ok

class RecordingI2c final : public hal::I2c {
 public:
  RecordingI2c(hal::I2c& bus, hal::Recorder& recorder) : bus_(&bus), recorder_(&recorder) {}

 private:
  hal::Result<> do_transfer(std::uint8_t address, std::span<const std::byte> bytes,
                            std::span<std::byte> into) override {
    auto answer = into.empty()    ? bus_->write(address, bytes)
                  : bytes.empty() ? bus_->read(address, into)
                                  : bus_->write_read(address, bytes, into);
    recorder_->take(name(), "transfer", {hal::field(address), hal::field(bytes), hal::field(into.size())},
                    answer
                        ? hal::Result<hal::Fields>(hal::Fields{hal::field(std::span<const std::byte>(into))})
                        : hal::fail(answer.error()));
    return answer;
  }
  [[nodiscard]] std::string_view do_name() const override { return bus_->name(); }
  hal::I2c* bus_;
  hal::Recorder* recorder_;
};

class RecordingModbus final : public hal::Modbus {
 public:
  RecordingModbus(hal::Modbus& bus, hal::Recorder& recorder) : bus_(&bus), recorder_(&recorder) {}

  // Unit and register, then what is written, if anything.
  static hal::Fields fields_of(std::uint8_t unit, std::uint16_t address,
                               std::span<const std::uint16_t> values) {
    hal::Fields fields{hal::field(unit), hal::field(address)};
    for (const std::uint16_t value : values) fields.push_back(hal::field(value));
    return fields;
  }
  static constexpr std::string_view read_name(bool holding) {
    return holding ? "read_holding" : "read_input";
  }

 private:
  hal::Result<> do_read(Table table, std::uint8_t unit, std::uint16_t address,
                        std::span<std::uint16_t> into) override {
    const bool holding = table == Table::holding;
    auto answer = holding ? bus_->read_holding(unit, address, into) : bus_->read_input(unit, address, into);
    hal::Fields values;
    for (const std::uint16_t value : into) values.push_back(hal::field(value));
    recorder_->take(name(), read_name(holding),
                    {hal::field(unit), hal::field(address), hal::field(into.size())},
                    answer ? hal::Result<hal::Fields>(std::move(values)) : hal::fail(answer.error()));
    return answer;
  }
  hal::Result<> do_write(std::uint8_t unit, std::uint16_t address,
                         std::span<const std::uint16_t> values) override {
    return taken(*recorder_, name(), "write_holding", fields_of(unit, address, values),
                 bus_->write_holding(unit, address, values));
  }
  hal::Result<> do_write_coil(std::uint8_t unit, std::uint16_t address, bool on) override {
    return taken(*recorder_, name(), "write_coil", {hal::field(unit), hal::field(address), hal::field(on)},
                 bus_->write_coil(unit, address, on));
  }
  [[nodiscard]] std::string_view do_name() const override { return bus_->name(); }
  hal::Modbus* bus_;
  hal::Recorder* recorder_;
};

}  // namespace forager::mocks
