#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "mocks/tag_field.hpp"

namespace forager::mocks {

// Why the reader says no: the "CODE: text" of its error envelope.
struct Refusal {
  std::string code;
  std::string text;
};
template <class T = void>
using Answer = tl::expected<T, Refusal>;
[[nodiscard]] inline tl::unexpected<Refusal> refuse(std::string code, std::string text) {
  return tl::unexpected(Refusal{std::move(code), std::move(text)});
}

struct SimAntenna {
  int port = 1;
  int orientation = -1;
  std::string location;
  std::string x = "0";
  std::string y = "0";
  std::string z = "0";
  std::string power;  // dBm as written; empty: the reader's RF_READ_POWER
  std::string sensitivity;
  std::string read_time;  // ms; empty: the read mode's
};

// Everything a client can set in an AdvanReader and that a save keeps: a plain value. Values stand as they
// were written, because that is how they are read back. Every setter validates and changes nothing when it
// refuses; what this emulator cannot do (multiplexers, filters, TID) is refused too.
class SimReaderSettings {
 public:
  SimReaderSettings(std::string device_id, int ports, bool autostart);

  // Reader parameters, device parameters and MCU parameters of the AdvanNet parameter tables, by name.
  // Refusals: PARAMETER_ERROR (unknown name, value not allowed), OPERATION_NOT_EXECUTED (read only).
  [[nodiscard]] Answer<> set_parameter(std::string_view name, std::string_view value);
  [[nodiscard]] Answer<std::string> parameter(std::string_view name) const;
  [[nodiscard]] static bool is_read_only(std::string_view name);
  // Names as they appear under /reader/params, /parameter or /MCU.
  [[nodiscard]] static std::vector<std::string_view> reader_parameter_names();

  // "Autonomous" or "Sequential", as listed. Refusal: DEVICEMODE_DO_NOT_EXIST.
  [[nodiscard]] Answer<> set_device_mode(std::string_view id);
  // "AUTONOMOUS" or "SEQUENTIAL"; only the one the device mode has. Refusal: INVALID_READMODE.
  [[nodiscard]] Answer<> set_read_mode(std::string_view name);
  [[nodiscard]] bool sequential() const { return sequential_; }
  [[nodiscard]] std::string_view device_mode() const { return sequential_ ? "Sequential" : "Autonomous"; }
  [[nodiscard]] std::string_view read_mode() const { return sequential_ ? "SEQUENTIAL" : "AUTONOMOUS"; }

  // Body of PUT readModes[0]: <request> with class, name and parameters; what is left out stays.
  [[nodiscard]] Answer<> set_read_mode_parameters(std::string_view xml);
  void append_read_mode(std::string& out) const;
  [[nodiscard]] int read_mode_ms(std::string_view parameter) const;  // timeWindow, readTime, onTime, offTime
  [[nodiscard]] bool keep_all_reads() const;

  // Body of PUT antennas, replaces the whole list; "def" strings and the expanded form.
  [[nodiscard]] Answer<> set_antennas(std::string_view xml);
  void append_antennas(std::string& out) const;
  [[nodiscard]] const std::vector<SimAntenna>& antennas() const { return antennas_; }

  // What the radio is to do, in the field's terms.
  [[nodiscard]] RadioSettings radio() const;

 private:
  using Values = std::map<std::string, std::string, std::less<>>;
  [[nodiscard]] Answer<SimAntenna> antenna_from(std::string_view entry) const;

  std::string device_id_;
  int ports_;
  bool sequential_ = false;
  Values parameters_;
  Values autonomous_;
  Values sequential_values_;
  std::vector<SimAntenna> antennas_;
};

}  // namespace forager::mocks
