#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "flight/inventory_sink.hpp"
#include "flight/pose_history.hpp"
#include "reader/new_tag_counter.hpp"
#include "reader/read_plan.hpp"
#include "reader/tag_read.hpp"

namespace forager::flight {

// What one port of the reader has contributed so far.
struct PortTally {
  std::uint8_t port = 0;
  std::uint64_t reads = 0;  // with the reader's own folding
  double new_tags = 0.0;    // credited to it by the share rule, in windows that are not open any more
};

// A listening window that has closed.
struct ClosedWindow {
  std::span<const reader::PortWeight> weights;  // in plan order; valid until the next window closes
  std::uint32_t new_tags = 0;
  std::uint32_t fresh_tags = 0;  // new since the decision before, with those heard between windows
};

// Where reads go: into the count of new tags and, with the pose at which each was heard, into the inventory.
class ReadIntake {
 public:
  ReadIntake(std::span<const reader::ReadPort> ports, reader::ShareRule rule, std::size_t expected_tags,
             InventorySink& sink);

  void take(std::span<const reader::TagRead> reads, const PoseHistory& history);

  // Ends the window for a decision.
  ClosedWindow close_window();
  // The decision took nothing from the window: its tags stay new.
  void keep_window();
  // What was heard on the way pulls nowhere any more (the body has turned or moved since); it is counted, and
  // fresh in the next window.
  void drop_window();

  [[nodiscard]] std::uint64_t reads() const { return reads_; }
  // Different tags in all windows closed so far.
  [[nodiscard]] std::size_t unique_tags() const { return unique_; }
  [[nodiscard]] std::span<const PortTally> ports() const { return ports_; }

 private:
  void credit(std::span<const reader::PortWeight> weights, double sign);

  InventorySink* sink_;
  reader::NewTagCounter counter_;
  std::vector<PortTally> ports_;
  std::vector<reader::PortWeight> last_weights_;
  std::uint64_t reads_ = 0;
  std::size_t unique_ = 0;
  std::size_t decided_on_ = 0;  // unique tags at the last decision
};

}  // namespace forager::flight
