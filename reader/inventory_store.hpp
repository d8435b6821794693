#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/error.hpp"
#include "hal/pose.hpp"
#include "reader/tag_read.hpp"

namespace forager::reader {

// A read with where the vehicle was when it was heard.
struct LocatedRead {
  TagRead read;
  hal::Pose pose_world;
  bool pose_known = false;  // false: no valid pose at that time
};

// One line of the inventory.
struct InventoryItem {
  Epc epc;
  hal::Instant first_seen;
  hal::Instant last_seen;
  std::uint64_t count = 0;         // reads, with the reader's own folding
  std::int16_t best_rssi_dbm = 0;  // strongest
  std::uint8_t best_port = 0;      // port and pose of the strongest read
  hal::Pose best_pose_world;
  bool pose_known = false;
};

// Durable inventory. Batches are numbered by the caller, 1, 2, 3, ...; a batch is in the store wholly or not
// at all, and a number already stored is accepted and ignored. So: a read is acknowledged when commit()
// returns, a kill at any moment loses no acknowledged read, and sending an unacknowledged batch again counts
// nothing twice.
class InventoryStore {
 public:
  virtual ~InventoryStore() = default;
  // Errors: io (disk full, read-only), busy (another process writes), invalid_argument (a gap in the
  // numbers).
  [[nodiscard]] virtual hal::Result<> commit(std::uint64_t batch, std::span<const LocatedRead> reads) = 0;
  // Number of the last batch stored; 0 for a new inventory.
  [[nodiscard]] virtual std::uint64_t last_batch() const = 0;
  // All items, ordered by EPC.
  [[nodiscard]] virtual hal::Result<std::vector<InventoryItem>> items() const = 0;
  // Small facts about the run, kept beside the reads (scene, policy, seed, end reason). Errors as commit().
  [[nodiscard]] virtual hal::Result<> set_fact(const std::string& key, const std::string& value) = 0;
  [[nodiscard]] virtual hal::Result<std::vector<std::pair<std::string, std::string>>> facts() const = 0;
};

// Keeps everything in memory; for tests and runs that asked for no file.
[[nodiscard]] std::unique_ptr<InventoryStore> make_memory_inventory();

enum class StoreMode : std::uint8_t {
  create,  // must not exist yet
  resume,  // created if missing, else continued
  read,    // must exist; commit() is refused
};
// SQLite in WAL mode. Errors: not_present, permission, busy, protocol (not one of our files, or of a later
// version), unsupported (built without SQLite; the mend names the package).
[[nodiscard]] hal::Result<std::unique_ptr<InventoryStore>> open_sqlite_inventory(const std::string& path,
                                                                                 StoreMode mode);

}  // namespace forager::reader
