#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "hal/modbus.hpp"
#include "mocks/sim_modbus_slave.hpp"

namespace forager::mocks {

// A line in this process with emulated slaves on it: what one of them answers comes back, as bytes with an
// RTU checksum; when none does, the time-out has passed.
class SimModbusBus final : public hal::Modbus {
 public:
  explicit SimModbusBus(std::string name = "modbus sim") : name_(std::move(name)) {}
  void attach(SimModbusSlave& slave) { slaves_.push_back(&slave); }  // borrowed; RTU framing
  void unplug(bool out = true) { unplugged_ = out; }
  std::uint32_t exchanges = 0;

 private:
  hal::Result<> do_read(Table table, std::uint8_t unit, std::uint16_t address,
                        std::span<std::uint16_t> into) override;
  hal::Result<> do_write(std::uint8_t unit, std::uint16_t address,
                         std::span<const std::uint16_t> values) override;
  hal::Result<> do_write_coil(std::uint8_t unit, std::uint16_t address, bool on) override;
  [[nodiscard]] std::string_view do_name() const override { return name_; }
  // Sends a request and gives what came back behind unit and function.
  hal::Result<std::vector<std::uint8_t>> exchange(std::uint8_t unit, std::vector<std::uint8_t> pdu,
                                                  const std::string& operation);

  std::string name_;
  std::vector<SimModbusSlave*> slaves_;
  bool unplugged_ = false;
};

}  // namespace forager::mocks
