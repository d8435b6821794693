#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "reader/epc_table.hpp"
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

// Counts EPCs never counted before in this mission, per antenna and window (the stigmergic weights, RFID-SOAN
// step 1). The weights do not depend on the order in which the reads of a window arrive: who was first is
// decided by TagRead::heard. Allocates only when the number of known EPCs outgrows `expected_tags`.
class NewTagCounter {
 public:
  // ports: of a validated read plan (1..32 of them, distinct).
  NewTagCounter(std::span<const ReadPort> ports, ShareRule rule, std::size_t expected_tags);

  // Reads of ports that are not in the plan are ignored and counted in strangers().
  void add(const TagRead& read);

  // Ends the window: its new tags are counted now and will not be new again, unless reopen() follows.
  // One entry per planned port, in plan order; valid until the next close_window().
  std::span<const PortWeight> close_window();

  // Takes the last closed window back: no decision came of it, so its tags stay new and carry over, with the
  // antenna that heard them first, into the window now open. Reads that came since then still count towards
  // who was first. A second call changes nothing: only one window can be taken back.
  void reopen();

  // In the last closed window; 0 before the first and after reopen().
  [[nodiscard]] std::uint32_t new_tags() const { return new_tags_; }
  // In the mission so far, all closed windows not taken back.
  [[nodiscard]] std::size_t counted() const { return counted_; }
  // Reads of ports that are not in the plan.
  [[nodiscard]] std::uint64_t strangers() const { return strangers_; }

  // An EPC known before the mission (resumed inventory): never new.
  void mark_known(const Epc& epc);

 private:
  struct Sighting {
    hal::Instant first_heard;
    std::uint32_t heard_by = 0;    // bit i: planned port i
    std::uint8_t first_index = 0;  // planned port that heard it first
    bool known = false;            // was in the inventory before the mission
  };

  void credit(const Sighting& sighting);
  void share_out();

  static constexpr std::size_t kMaxPorts = 32;
  static constexpr std::uint8_t kNotPlanned = 0xFF;

  ShareRule rule_;
  std::array<std::uint8_t, 256> index_of_port_{};
  std::vector<PortWeight> weights_;
  std::vector<std::uint32_t> shared_by_;  // [port index * (ports + 1) + k]: new tags shared by k antennas
  // In order of first arrival, so every window is a range:
  // counted for good | last closed window | window now open
  EpcTable<Sighting> sightings_;
  std::size_t closed_begin_ = 0;
  std::size_t open_begin_ = 0;
  std::uint32_t new_tags_ = 0;
  std::size_t counted_ = 0;
  std::uint64_t strangers_ = 0;
};

}  // namespace forager::reader
