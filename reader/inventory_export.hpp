#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "hal/time.hpp"
#include "reader/inventory_store.hpp"

namespace forager::reader {

// The inventory in a few numbers.
struct InventorySummary {
  std::uint64_t items = 0;
  std::uint64_t reads = 0;
  std::uint64_t located = 0;  // items whose strongest read has a pose
  hal::Instant first_seen;    // earliest and latest read of all; meaningless without items
  hal::Instant last_seen;
  std::int16_t strongest_dbm = 0;    // over the items' best RSSI; meaningless without items
  std::int16_t median_best_dbm = 0;  // lower median
  std::int16_t weakest_best_dbm = 0;
};
[[nodiscard]] InventorySummary summarize(std::span<const InventoryItem> items);

// RFC 4180 with a header line:
// epc,reads,first_seen_s,last_seen_s,best_rssi_dbm,best_port,x_m,y_m,z_m,yaw_rad. Times are seconds on the
// run's time line, exact to the nanosecond; numbers read back to the same double; the pose columns are empty
// where no pose was known.
[[nodiscard]] std::string to_csv(std::span<const InventoryItem> items);

// One JSON object per line, keys as in to_csv() after "type":"item"; null where no pose was known.
[[nodiscard]] std::string to_json_lines(std::span<const InventoryItem> items);

// Seconds with nine decimals, exact: "12.000000345".
[[nodiscard]] std::string exact_seconds(hal::Instant t);

}  // namespace forager::reader
