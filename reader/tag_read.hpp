#pragma once

#include <cstdint>
#include <optional>

#include "hal/time.hpp"
#include "reader/epc.hpp"

namespace forager::reader {

// One read event of one tag by one antenna port.
struct TagRead {
  static constexpr std::int16_t kNoRssi = -32768;  // weaker than any report, so "strongest" stays right

  Epc epc;
  std::uint8_t port = 0;            // reader port, 1-based; 0 if not reported
  std::int16_t rssi_dbm = 0;        // as reported; kNoRssi if not reported
  std::optional<double> phase_deg;  // backscatter phase, if reported
  std::uint32_t frequency_khz = 0;  // carrier, 0 if not reported
  std::uint32_t read_count = 1;     // reads folded into this event
  std::int64_t reader_ms = 0;       // reader clock, Unix milliseconds, as sent (may be years off)
  hal::Instant heard;               // reader time moved to the run's time line by the estimated clock offset
  hal::Instant arrived;             // when the bytes reached us
};

}  // namespace forager::reader
