#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::hal {

// What passed between a driver and its devices, one line for a call: recorded in the field, replayed at the
// desk. Plain text, in the order of the calls:
//
//   forager recording 1
//   12.040000000 i2c%20/dev/i2c-1 transfer 64 06 2 = ok 1e00
//   12.060000000 udp%20192.168.1.50:14550 <bytes = ok fd0900
//   12.080000000 i2c%20/dev/i2c-1 transfer 64 06 2 = error no_ack i2c%20/dev/i2c-1 transfer%20with%200x40 ...
//
// Seconds with nine decimals, the device, the operation, what was asked, =, and the answer. An operation that
// begins with < is no call but something that came by itself: it is noted when it came and not every time
// somebody looked. Fields are separated by one space; a space, %, = or a byte that is no printable ASCII is
// written as % and two hexadecimal digits, an empty field as -, and one that is a - as %2d. Bytes on a wire
// are hexadecimal digits without anything between. Which fields an operation has is said where it is recorded
// (mocks/recording_*.hpp).
using Fields = std::vector<std::string>;

struct Record {
  Instant at;
  std::string device;
  std::string operation;
  Fields asked{};
  Result<Fields> answer{};
};

inline constexpr std::string_view kRecordingHead = "forager recording 1";

// One line, without its end.
[[nodiscard]] std::string to_line(const Record& record);
// Errors: protocol, saying what is wrong.
[[nodiscard]] Result<Record> parse_record(std::string_view line);
// A whole recording; empty lines and lines that begin with # are left out. A last line that was cut off in
// the middle (the battery ran out) is left out, too, if it has no line break. Errors: protocol, with the
// number of the line.
[[nodiscard]] Result<std::vector<Record>> parse_recording(std::string_view text);

// Fields from values and back. A field that does not parse gives nothing.
[[nodiscard]] std::string field(std::span<const std::byte> bytes);
[[nodiscard]] std::string field(Duration time);  // nanoseconds
// Flags are 1 and 0; a double is the shortest text that gives the same double.
template <class Number>
requires std::is_arithmetic_v<Number>
[[nodiscard]] std::string field(Number value) {
  if constexpr (std::is_same_v<Number, bool>) return value ? "1" : "0";
  if constexpr (!std::is_same_v<Number, bool>) {
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
  }
}
[[nodiscard]] std::optional<std::vector<std::byte>> bytes_in(std::string_view field);
[[nodiscard]] std::optional<std::int64_t> integer_in(std::string_view field);
[[nodiscard]] std::optional<double> number_in(std::string_view field);

// Takes records down, in order. Never fails towards the caller; what cannot be written is lost.
class Recorder {
 public:
  // `clock` gives calls their time and must outlive the recorder; `sink` gets every line with its end, the
  // head first and then a record that tells when it began.
  Recorder(const Clock& clock, std::function<void(std::string_view line)> sink);

  void take(std::string_view device, std::string_view operation, Fields asked, Result<Fields> answer);
  [[nodiscard]] std::uint64_t records() const { return records_; }

 private:
  const Clock* clock_;
  std::function<void(std::string_view line)> sink_;
  std::uint64_t records_ = 0;
};

}  // namespace forager::hal
