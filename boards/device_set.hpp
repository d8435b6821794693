#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "boards/board.hpp"
#include "boards/scene.hpp"
#include "boards/world_tags.hpp"
#include "hal/byte_stream.hpp"
#include "hal/depth_source.hpp"
#include "hal/error.hpp"
#include "hal/http_client.hpp"
#include "hal/journal.hpp"
#include "hal/pose_source.hpp"
#include "hal/time.hpp"

namespace forager::boards {

// Reads a counter that grows with time; for measuring where a run's time goes. Null: not measured.
using TickCounter = std::uint64_t (*)();

// Ticks spent inside the emulated devices since the start.
struct DeviceTicks {
  std::uint64_t autopilot = 0;  // flight controller and vehicle
  std::uint64_t reader = 0;     // reader and the air
};

// What is known of the simulated world; for summaries and the report.
struct WorldFacts {
  std::vector<SceneShelf> shelves;
  WorldTags tags;
  std::shared_ptr<const mocks::TagList> layout;  // where they are listed; null: where they are
};

// The devices of one run, whatever stands behind them. The set owns them; drivers borrow.
class DeviceSet {
 public:
  virtual ~DeviceSet() = default;
  [[nodiscard]] virtual hal::HttpClient& reader_rest() = 0;
  [[nodiscard]] virtual hal::ByteStream& reader_events() = 0;
  [[nodiscard]] virtual hal::ByteStream& autopilot() = 0;
  [[nodiscard]] virtual hal::DepthSource& depth() = 0;
  [[nodiscard]] virtual hal::PoseSource& pose() = 0;
  // Lets emulated devices live up to `now`; real ones do that by themselves.
  virtual void advance(hal::Instant now) = 0;
  [[nodiscard]] virtual const WorldFacts* world() const = 0;  // null: a real place
  [[nodiscard]] virtual DeviceTicks ticks() const { return {}; }
  // Contacts of the simulated vehicle with shelves or hard landings so far.
  [[nodiscard]] virtual std::uint32_t crashes() const { return 0; }
};

struct DeviceOptions {
  std::uint64_t seed = 1;
  hal::Journal* journal = nullptr;  // must outlive the set; null: none
  bool journal_wire = false;        // the emulators' bytes too
  TickCounter counter = nullptr;
};

// Everything emulated in this process on the caller's time line.
[[nodiscard]] hal::Result<std::unique_ptr<DeviceSet>> make_sim_devices(const Scene& scene,
                                                                       const DeviceOptions& options);

// Reader and autopilot over sockets. Errors: not_present (password variable not set), unsupported.
[[nodiscard]] hal::Result<std::unique_ptr<DeviceSet>> make_socket_devices(const Scene& scene,
                                                                          const Board& board,
                                                                          const DeviceOptions& options);

[[nodiscard]] hal::Result<std::unique_ptr<DeviceSet>> make_devices(const Scene& scene, const Board& board,
                                                                   const DeviceOptions& options);

}  // namespace forager::boards
