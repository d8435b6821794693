#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "hal/halt.hpp"
#include "hal/time.hpp"
#include "reader/tag_read.hpp"

namespace forager::reader {

enum class LinkPhase : std::uint8_t {
  closed,   // nothing asked for yet, or stopped on request
  opening,  // finding, configuring, starting
  open,     // reading (bytes, reads or keep-alives arrive)
  lost,     // was or should be open; waiting to try again
  failed,   // will not heal by trying again (wrong password, plan refused): a person must act
};
[[nodiscard]] std::string_view to_string(LinkPhase phase);

// The state of a link with its reason and since when: what an operator needs to know about "no tags".
struct LinkStatus {
  LinkPhase phase = LinkPhase::closed;
  std::string reason;        // last cause of the present phase, empty when open
  hal::Instant since;        // start of the present phase
  hal::Instant last_heard;   // last byte of any kind from the device
  std::uint32_t losses = 0;  // times the link went from open to lost
  bool speaks = true;        // since it opened, the device has said something that was understood (a driver
                             // that cannot tell says true)
  // Silence of such a link means that there are no tags. A connection that delivers nothing, or only noise,
  // is none.
  [[nodiscard]] bool reading() const { return phase == LinkPhase::open && speaks; }
};

// A running tag reader of any make. update() does all the work and never blocks; reads() gives what it found.
// Safe state (construction, halt): not radiating as far as the device can still be told.
class TagReader : public hal::Halt {
 public:
  // Asks the reader to run its plan; progress shows in link().
  virtual void start(hal::Instant now) = 0;
  // Drives the device: sends what is due, takes in what has arrived.
  virtual void update(hal::Instant now) = 0;
  // Reads taken in by the last update(), in order of arrival. Valid until the next update().
  [[nodiscard]] virtual std::span<const TagRead> reads() const = 0;
  [[nodiscard]] virtual const LinkStatus& link() const = 0;
};

}  // namespace forager::reader
