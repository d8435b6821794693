#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace forager::mocks {

// What a setting of the AdvanReader may hold: one row of its parameter tables.
struct SimReaderValue {
  enum class Kind : std::uint8_t { number, words, boolean, fixed };
  enum class Group : std::uint8_t { reader, device, mcu };
  std::string_view name;
  std::string_view initial{};
  Kind kind = Kind::fixed;
  double low = 0.0;  // number: range and step (0: any)
  double high = 0.0;
  double step = 0.0;
  std::string_view words{};  // words: allowed values between blanks
  bool read_only = false;
  Group group = Group::reader;
};

[[nodiscard]] std::span<const SimReaderValue> sim_reader_parameters();
[[nodiscard]] std::span<const SimReaderValue> sim_autonomous_parameters();
[[nodiscard]] std::span<const SimReaderValue> sim_sequential_parameters();
[[nodiscard]] const SimReaderValue* find_value(std::span<const SimReaderValue> table, std::string_view name);
[[nodiscard]] bool allows(const SimReaderValue& value, std::string_view text);
// A whole decimal number ("-70", "27.5") and nothing else.
[[nodiscard]] std::optional<double> decimal(std::string_view text);

}  // namespace forager::mocks
