#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/error.hpp"
#include "hal/journal.hpp"
#include "hal/time.hpp"
#include "reader/inventory_store.hpp"

namespace forager::flight {

struct InventorySinkConfig {
  std::size_t batch_reads = 256;                                  // commit when so many are waiting
  hal::Duration batch_interval = std::chrono::seconds(1);         // or the oldest has waited this long
  hal::Duration retry_interval = std::chrono::milliseconds(500);  // after a failed commit
};

// Collects reads into batches for the store. A batch that the store refused stays as it is and is sent again
// under the same number until the store takes it; later reads wait behind it. No read is dropped. Allocates
// only while the store refuses or a burst is longer than two batches.
class InventorySink {
 public:
  InventorySink(reader::InventoryStore& store, hal::Journal& journal, const InventorySinkConfig& config);

  void add(const reader::LocatedRead& read) { filling_.push_back(read); }
  // Commits what is due.
  void update(hal::Instant now);
  // Commits everything now, whatever the intervals say; false if the store still refuses.
  bool flush(hal::Instant now);

  // Since when the store has refused without a success between; nullopt when all is well.
  [[nodiscard]] std::optional<hal::Instant> failing_since() const { return failing_since_; }
  [[nodiscard]] const std::string& last_error() const { return last_error_; }
  [[nodiscard]] std::size_t waiting() const { return filling_.size() + sending_.size(); }

 private:
  bool commit(hal::Instant now);

  reader::InventoryStore* store_;
  hal::Journal* journal_;
  InventorySinkConfig config_;
  std::vector<reader::LocatedRead> filling_;
  std::vector<reader::LocatedRead> sending_;
  std::uint64_t next_batch_;  // number of the batch in sending_, or of the next one
  std::optional<hal::Instant> oldest_waits_since_;
  hal::Instant retry_at_;
  std::optional<hal::Instant> failing_since_;
  std::string last_error_;
};

}  // namespace forager::flight
