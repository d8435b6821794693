#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "boards/board.hpp"
#include "boards/device_set.hpp"
#include "boards/recorded_devices.hpp"
#include "boards/run_summary.hpp"
#include "boards/scene.hpp"
#include "flight/mission_status.hpp"
#include "hal/error.hpp"
#include "hal/journal.hpp"
#include "hal/time.hpp"
#include "reader/inventory_store.hpp"
#include "reader/tag_reader.hpp"

namespace forager::boards {

struct RunOptions {
  std::uint64_t seed = 1;
  std::string inventory_path{};  // SQLite file; empty: kept in memory
  hal::Journal* journal = nullptr;
  bool journal_wire = false;  // bytes of both links and of the emulators' streams too
  TickCounter counter = nullptr;
  const RunRecording* recording = nullptr;  // takes down what passes between drivers and devices
};

// Ticks of RunOptions::counter spent where.
struct RunTicks {
  DeviceTicks devices;
  std::uint64_t loop = 0;  // drivers, codecs, decisions, inventory, camera
};

// A mission put together from a scene and a board: devices, drivers, policy, robot loop, inventory. The
// caller's loop calls update() with its time line every tick() until done().
class Run {
 public:
  static constexpr hal::Duration kTick = std::chrono::milliseconds(20);

  // Errors: those of make_devices, of the read plan's and drivers' checks, of open_sqlite_inventory;
  // unsupported.
  [[nodiscard]] static hal::Result<std::unique_ptr<Run>> prepare(const Scene& scene, const Board& board,
                                                                 const RunOptions& options, hal::Instant now);
  // The same with devices that are there already.
  [[nodiscard]] static hal::Result<std::unique_ptr<Run>> prepare_with(const Scene& scene, const Board& board,
                                                                      const RunOptions& options,
                                                                      hal::Instant now,
                                                                      std::unique_ptr<DeviceSet> devices);
  // A run that is not done is abandoned.
  virtual ~Run() = default;

  virtual void update(hal::Instant now) = 0;
  // Asks to land and end; the run goes on until it is done.
  virtual void halt() noexcept = 0;
  // For a caller whose update() fails again and again: the vehicle, if it is ours, is told at once to land.
  // The reader is told to stop; done() when it has heard, or after a while.
  virtual void abandon() noexcept = 0;
  [[nodiscard]] virtual bool done() const = 0;

  [[nodiscard]] virtual const Scene& scene() const = 0;
  [[nodiscard]] virtual const flight::MissionStatus& status() const = 0;
  [[nodiscard]] virtual const reader::LinkStatus& reader_link() const = 0;
  [[nodiscard]] virtual std::span<const flight::FlownPath::Point> path() const = 0;
  // New tags per port so far, in the order of the read plan.
  [[nodiscard]] virtual std::vector<PortSummary> ports() const = 0;
  [[nodiscard]] virtual const WorldFacts* world() const = 0;
  [[nodiscard]] virtual const reader::InventoryStore& inventory() const = 0;
  [[nodiscard]] virtual RunTicks ticks() const = 0;
  // What it came to; also kept in the inventory's facts once done. Errors: those of the store.
  [[nodiscard]] virtual hal::Result<RunSummary> summary() = 0;
};

}  // namespace forager::boards
