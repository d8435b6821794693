#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reader/read_plan.hpp"
#include "reader/tag_read.hpp"

namespace forager::reader {

// New tags one antenna heard in a window: the length of its pull on the vehicle.
struct PortWeight {
  std::uint8_t port = 0;
  double bearing_rad = 0.0;  // body frame, from the read plan
  double weight = 0.0;       // new tags; fractions only with ShareRule::split
};

// Who gets a tag that several antennas heard in the window in which it was new.
enum class ShareRule : std::uint8_t {
  first_heard,  // the antenna with the earliest reader time; equal times go to the lower port
  split,        // equal shares
};

// Counts EPCs never counted before in this mission, per antenna and window (the stigmergic weights).
// Reads may come in any order. Allocates only when the number of known EPCs outgrows `expected_tags`.
class NewTagCounter {
 public:
  NewTagCounter(std::span<const ReadPort> ports, ShareRule rule, std::size_t expected_tags);

  // Reads of ports that are not in the plan are ignored and counted in strangers().
  void add(const TagRead& read);

  // Ends the window: its new tags are counted now and will not be new again, unless reopen() follows.
  // One entry per planned port, in plan order; valid until the next close_window().
  std::span<const PortWeight> close_window();

  // Takes the last closed window back: no decision came of it, so its tags stay new and carry over, with the
  // antenna that heard them first, into the window now open.
  void reopen();

  [[nodiscard]] std::uint32_t new_tags() const;  // in the last closed window
  [[nodiscard]] std::size_t counted() const;     // in the mission so far, all windows
  [[nodiscard]] std::uint64_t strangers() const;

  // An EPC known before the mission (resumed inventory): never new.
  void mark_known(const Epc& epc);

  // Left public part ends here; the representation is the implementation's business.
 private:
  struct Impl;
};

}  // namespace forager::reader
