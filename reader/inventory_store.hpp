#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hal/error.hpp"
#include "hal/pose.hpp"
#include "hal/time.hpp"
#include "reader/tag_read.hpp"

namespace forager::reader {

// A read with where the vehicle was when it was heard.
struct LocatedRead {
  TagRead read;
  hal::Pose pose_world;
  bool pose_known = false;  // false: no valid pose at that time
};

// One line of the inventory. Times are TagRead::heard as given; whoever resumes an inventory keeps to one
// time line over all its runs, or times of different runs do not compare.
struct InventoryItem {
  Epc epc;
  hal::Instant first_seen;
  hal::Instant last_seen;
  std::uint64_t count = 0;         // reads, with the reader's own folding
  std::int16_t best_rssi_dbm = 0;  // strongest
  std::uint8_t best_port = 0;      // port and pose of the strongest read; of equals, the one stored first
  hal::Pose best_pose_world;
  bool pose_known = false;
};

// What one port of the reader contributed.
struct PortTotal {
  std::uint8_t port = 0;
  std::uint64_t reads = 0;  // with the reader's own folding
  std::uint64_t items = 0;  // items heard strongest here; over all ports they add up to the inventory
};

// Durable inventory. Batches are numbered by the caller, 1, 2, 3, ...; a batch is in the store wholly or not
// at all, and a number already stored is accepted and ignored. So: a read is acknowledged when commit()
// returns, a kill at any moment loses no acknowledged read, and sending an unacknowledged batch again counts
// nothing twice.
class InventoryStore {
 public:
  virtual ~InventoryStore() = default;
  // Errors: io (disk full, read-only), busy (another process writes: send the batch again later),
  // invalid_argument (a gap in the numbers, or number 0), invalid_state (opened for reading only), protocol
  // (the file was damaged). After an error nothing of the batch is stored.
  [[nodiscard]] virtual hal::Result<> commit(std::uint64_t batch, std::span<const LocatedRead> reads) = 0;
  // Number of the last batch stored, as of the last commit() or of opening; 0 for a new inventory.
  [[nodiscard]] virtual std::uint64_t last_batch() const = 0;
  // All items, ordered by EPC (bytes, a prefix first).
  [[nodiscard]] virtual hal::Result<std::vector<InventoryItem>> items() const = 0;
  // Small facts about the run, kept beside the reads (scene, policy, seed, end reason). A later value
  // replaces an earlier one. Errors as commit().
  [[nodiscard]] virtual hal::Result<> set_fact(const std::string& key, const std::string& value) = 0;
  // Ordered by key.
  [[nodiscard]] virtual hal::Result<std::vector<std::pair<std::string, std::string>>> facts() const = 0;
  // One entry per port that ever heard a tag, ordered by port. Empty for a store that does not keep them.
  [[nodiscard]] virtual hal::Result<std::vector<PortTotal>> port_totals() const {
    return std::vector<PortTotal>{};
  }
};

// Keeps everything in memory; for tests and runs that asked for no file.
[[nodiscard]] std::unique_ptr<InventoryStore> make_memory_inventory();

enum class StoreMode : std::uint8_t {
  create,  // must not exist yet
  resume,  // created if missing, else continued
  read,    // must exist; commit() is refused
};

// What a finished commit() survives. Either way the file is never left inconsistent and no batch is ever half
// there.
enum class Durability : std::uint8_t {
  process,  // kill -9, a crash of the program: nothing acknowledged is lost. A power cut or a crash of the
            // kernel may lose the newest batches, those since the log last went to the disk
            // (synchronous=NORMAL)
  power,    // a power cut too: every commit waits for the disk, 1..30 ms on an SD card (synchronous=FULL)
};

struct StoreOptions {
  StoreMode mode = StoreMode::resume;
  Durability durability = Durability::process;
  // Also keep every read with its pose in the table `read`, about 100 bytes each, for calibration and other
  // work after the run. Off: only the aggregate per EPC and per port.
  bool log_reads = false;
  // How long a call may block while another process writes, before it answers busy.
  hal::Duration busy_wait{};
};

// SQLite in WAL mode; tables as in docs/inventory.md. A store that is closed in order leaves a single plain
// file; one that was killed leaves a -wal and a -shm beside it, which belong to it and are taken in at the
// next opening. Errors: not_present (no such file or folder), permission, busy, invalid_argument (create: the
// file exists), protocol (not one of our files, damaged, or of a later version), unsupported (built without
// SQLite; the mend names the package), io.
[[nodiscard]] bool have_sqlite_inventory();  // false: built without SQLite
[[nodiscard]] hal::Result<std::unique_ptr<InventoryStore>> open_sqlite_inventory(const std::string& path,
                                                                                 const StoreOptions& options);
[[nodiscard]] inline hal::Result<std::unique_ptr<InventoryStore>> open_sqlite_inventory(
    const std::string& path, StoreMode mode) {
  StoreOptions options;
  options.mode = mode;
  return open_sqlite_inventory(path, options);
}

}  // namespace forager::reader
