#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hal/error.hpp"
#include "reader/tag_read.hpp"

namespace forager::reader {

// A digital input of the reader changed.
struct GpiEvent {
  std::uint8_t line = 0;       // 1-based
  bool high = false;           // level after the change
  std::int64_t reader_ms = 0;  // reader clock, Unix milliseconds; 0 if not reported
};

// One message of the event stream as values. Reused from message to message: after the largest has passed,
// decoding allocates nothing.
struct AdvanNetMessage {
  enum class Kind : std::uint8_t {
    inventory,     // <inventory>: reads, possibly none
    device_event,  // <deviceEventMessage>: inputs that changed, or something else named by `type`
    server_event,  // <eventMessage>
    unknown,       // another root element: newer firmware; not an error
  };
  Kind kind = Kind::unknown;
  std::vector<TagRead> reads;  // heard and arrived are left to the caller
  std::vector<GpiEvent> inputs;
  std::uint32_t bad_items = 0;  // items without a usable EPC or time, input events without line or level
  std::string type;             // of events: "DEVICE_STOP", "ADVANNET_READER_ERROR"
  std::string text;             // of events: the message, at most 256 bytes

  void clear();
};

// Decodes one frame body. The item's first <ts> is the time of the read. Properties are matched by the name
// before their first colon, in any order; RF_PHASE, FREQ and READ_COUNT may be missing; a missing port reads
// as 0 and a missing RSSI as TagRead::kNoRssi. A reader that folded several antennas into one item sends
// comma lists: one read per ANTENNA_PORT value, each taking the value at its own place from the other
// lists when they are equally long, else their first.
//
// Errors (nothing is kept of such a message): protocol (not well-formed, a document type, nested too deeply,
// NUL bytes), unsupported (JSON: the reader's COMM_TCP3177_ENCODER is not XML_V2_3).
[[nodiscard]] hal::Result<> decode_advannet_message(std::string_view body, AdvanNetMessage& out);

}  // namespace forager::reader
