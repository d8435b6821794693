#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "mocks/sim_reader_config.hpp"
#include "mocks/tag_field.hpp"

namespace forager::mocks {

// A read on its way out of the reader.
struct SimReadEvent {
  AirRead read;
  std::int64_t reader_ms = 0;  // time stamp by the reader's clock, Unix milliseconds
  std::int64_t read_count = 1;
  bool comma_props = false;  // two values in every property
};

using GpiLevels = std::array<bool, 4>;

// Writes what an AdvanReader says about reads and inputs, to the letter of the AdvanNet event stream.
// Appends to strings the caller keeps: steady use allocates nothing. A read costs about 600 bytes.
class SimReaderEvents {
 public:
  explicit SimReaderEvents(const SimReaderConfig& config);

  struct Context {
    std::int64_t now_ms = 0;
    GpiLevels gpi{};
    bool upper_case_epc = false;
    // Per port 1..: "location,x,y,z" for /location; empty: plain /inventory.
    std::span<const std::string> locations{};
  };
  // An <inventory> document with one READ_EVENT item per read, in the order given.
  void append_inventory(std::string& out, std::span<const SimReadEvent> reads, TagField& field,
                        const Context& context);
  // [{"epc":"...","ts":...,"port":1,"mux1":0,"mux2":0,"rssi":-60,"phase":45,"rc":1}]
  void append_json(std::string& out, std::span<const SimReadEvent> reads, TagField& field);
  // A <deviceEventMessage> of type GPI; line is 1-based.
  void append_gpi(std::string& out, int line, bool low_to_high, std::int64_t now_ms) const;

 private:
  void append_item(std::string& out, const SimReadEvent& event, std::string_view epc, const Context& context);

  std::string device_id_;
  std::string preamble_;  // from <deviceId> to before <size>
  std::string instance_;  // AdvanNet instance id
  std::string after_ts_;  // "</ts><deviceId>...</deviceId><data><class>TAG_DATA</class><hexepc>"
  std::string gpi_prop_;
  std::string epc_;
};

}  // namespace forager::mocks
