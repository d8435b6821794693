#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hal/time.hpp"

namespace forager::mocks {

// 11 February 2016, 17:53 UTC: where the clock of a reader without time server was seen to start.
inline constexpr std::int64_t kOldReaderClockMs = 1'455'213'225'000;

// Everything about an AdvanReader that has been seen to go wrong, or could. Chances are 0..1, drawn from the
// reader's seed; defaults: a reader on its best day. May be changed while the reader runs.
struct SimReaderFaults {
  // Event stream, per frame.
  double split_frame = 0.0;    // sent in pieces over several updates
  double join_frame = 0.0;     // held back and sent in one piece with the next
  double garbage_lines = 0.0;  // 1..3 lines that belong to no frame come first
  double pause = 0.0;          // the connection falls silent for pause_length, keep-alives too
  hal::Duration pause_length = std::chrono::seconds(9);
  double close_abruptly = 0.0;   // the connection is closed in the middle of the frame
  bool header_1_0 = false;       // "ADVANNET/1.0", as older firmware says
  bool bare_keep_alive = false;  // keep-alives without their Content-Type line

  // Reads.
  int stale_reads_after_start = 0;  // the first so many reads are preceded by one from before the start
  double out_of_order = 0.0;        // per read: delivered later than its time says ...
  hal::Duration out_of_order_max = std::chrono::milliseconds(1700);  // ... by up to this
  double duplicate = 0.0;                                            // per read: delivered twice
  double comma_props = 0.0;     // per read: two values in each property, as folded reads have
  bool upper_case_epc = false;  // EPC digits A..F instead of a..f

  // Network and REST.
  bool refuse_connects = false;    // nobody listens, neither for REST nor for the stream
  std::string refuse_operation{};  // this operation ("antennas", "start") answers with status ERROR
  int refuse_times = -1;           // ... so many times; -1: always
  hal::Duration rest_delay{};      // each REST request takes this long, one after the other
  double http_500 = 0.0;           // per request: HTTP status 500 and no envelope
  std::optional<std::int64_t> clock_at_boot_ms{};  // replaces the configured clock at the next boot
};

}  // namespace forager::mocks
