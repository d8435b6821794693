#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/time.hpp"

namespace forager::mocks {

// What the emulated reader's radio is set to, in the terms of its wire protocol.
struct RadioPort {
  int port = 0;  // 1-based
  double power_dbm = 30.0;
  double sensitivity_dbm = -80.0;
};
struct RadioSettings {
  int session = 0;           // 0..3
  char target = 'A';         // 'A', 'B', or '*' for both in turn (AB, BA)
  int q = -1;                // fixed Q, or -1 dynamic
  hal::Duration on_time{};   // RF on per cycle
  hal::Duration off_time{};  // RF off per cycle
  std::vector<RadioPort> ports;
};

// One reply heard on the air.
struct AirRead {
  std::uint32_t tag = 0;  // index of the tag in the world; SimReader asks the field for its EPC
  int port = 0;
  int rssi_dbm = 0;
  int phase_deg = 0;  // 0..180
  std::uint32_t frequency_khz = 0;
  hal::Instant at;
};

// The air between one reader and its tags, seen from the reader: the emulated reader drives it, a world or a
// script implements it. Time goes forward only.
class TagField {
 public:
  virtual ~TagField() = default;
  // RF goes on with these settings (reader start) or off (reader stop, or the reader lost power).
  virtual void radio_on(const RadioSettings& settings, hal::Instant now) = 0;
  virtual void radio_off(hal::Instant now) = 0;
  // Appends every reply in (previous advance, now], in time order.
  virtual void advance(hal::Instant now, std::vector<AirRead>& out) = 0;
  // EPC of a tag, lower-case hexadecimal; valid until the next call.
  [[nodiscard]] virtual const std::string& epc_hex(std::uint32_t tag) const = 0;
};

}  // namespace forager::mocks
