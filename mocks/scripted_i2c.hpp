#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "hal/i2c.hpp"
#include "mocks/scripted_failure.hpp"

namespace forager::mocks {

// A bus that expects transfers exactly as listed: "40 w 06 00 00 33 01" or "40 w 00 r 11", bytes in
// hexadecimal. Anything else is reported, and so is a script with transfers left at destruction.
class ScriptedI2c final : public hal::I2c {
 public:
  explicit ScriptedI2c(ScriptFailure on_failure = abort_on_script_failure());
  ~ScriptedI2c() override;
  ScriptedI2c(const ScriptedI2c&) = delete;
  ScriptedI2c& operator=(const ScriptedI2c&) = delete;

  ScriptedI2c& expect(std::string_view transfer);
  [[nodiscard]] bool done() const { return script_.empty(); }

 private:
  hal::Result<> do_transfer(std::uint8_t address, std::span<const std::byte> bytes,
                            std::span<std::byte> into) override;
  [[nodiscard]] std::string_view do_name() const override { return "scripted i2c"; }

  ScriptFailure on_failure_;
  std::deque<std::string> script_;
};

}  // namespace forager::mocks
