#include <utility>

#include "boards/device_set.hpp"
#include "boards/sim_air.hpp"
#include "boards/world_builder.hpp"
#include "mocks/memory_stream.hpp"
#include "mocks/ray_cast_depth.hpp"
#include "mocks/sim_autopilot.hpp"
#include "mocks/sim_http_client.hpp"
#include "mocks/sim_pose_source.hpp"
#include "mocks/sim_reader.hpp"

namespace forager::boards {
namespace {

// Room for what the reader sends between two updates at its peak rate, many times over.
constexpr std::size_t kStreamBytes = 4U << 20U;
constexpr std::size_t kTelemetryBytes = 64U << 10U;

class SimDevices final : public DeviceSet {
 public:
  SimDevices(const Scene& scene, const DeviceOptions& options)
      : options_(options),
        world_(build_world(scene, options.seed)),
        facts_(facts_of(scene, world_, options.seed)),
        telemetry_("sim autopilot", mocks::MemoryStreamKind::datagrams, kTelemetryBytes),
        events_("sim reader events", mocks::MemoryStreamKind::bytes, kStreamBytes),
        autopilot_(telemetry_.far(), autopilot_config(scene, options.seed)),
        field_(make_field(scene, world_, autopilot_, seed_for(options.seed, SeedStream::air))),
        reader_(reader_config(options), *field_, journal()),
        rest_(
            {.name = "http sim-reader", .latency = std::chrono::milliseconds(5), .user = {}, .password = {}},
            reader_),
        depth_(world_, autopilot_, depth_options(scene), seed_for(options.seed, SeedStream::camera)),
        pose_(autopilot_, pose_options(scene), seed_for(options.seed, SeedStream::pose)) {
    autopilot_.attach(&world_, options.journal, options.journal_wire);
    autopilot_.set_battery_fraction(scene.vehicle.battery_start);
    reader_.streams().attach(events_);
  }

  hal::HttpClient& reader_rest() override { return rest_; }
  hal::ByteStream& reader_events() override { return events_.near(); }
  hal::ByteStream& autopilot() override { return telemetry_.near(); }
  hal::DepthSource& depth() override { return depth_; }
  hal::PoseSource& pose() override { return pose_; }
  const WorldFacts* world() const override { return &facts_; }
  DeviceTicks ticks() const override { return ticks_; }
  std::uint32_t crashes() const override {
    return autopilot_.vehicle().collisions() + autopilot_.vehicle().hard_landings();
  }

  void advance(hal::Instant now) override {
    const std::uint64_t start = count();
    autopilot_.update(now);
    const std::uint64_t middle = count();
    reader_.update(now);
    ticks_.autopilot += middle - start;
    ticks_.reader += count() - middle;
  }

 private:
  static mocks::SimReaderConfig reader_config(const DeviceOptions& options) {
    mocks::SimReaderConfig config;
    config.seed = seed_for(options.seed, SeedStream::reader);
    config.journal_wire = options.journal_wire;
    return config;
  }
  hal::Journal& journal() { return options_.journal != nullptr ? *options_.journal : null_journal_; }
  [[nodiscard]] std::uint64_t count() const { return options_.counter != nullptr ? options_.counter() : 0; }

  DeviceOptions options_;
  hal::NullJournal null_journal_;
  DeviceTicks ticks_;
  mocks::World world_;
  WorldFacts facts_;
  mocks::MemoryStreamPair telemetry_;
  mocks::MemoryStreamPair events_;
  mocks::SimAutopilot autopilot_;
  std::unique_ptr<mocks::TagField> field_;
  mocks::SimReader reader_;
  mocks::SimHttpClient rest_;
  mocks::SimDepthCamera depth_;
  mocks::SimPoseSource pose_;
};

}  // namespace

hal::Result<std::unique_ptr<DeviceSet>> make_sim_devices(const Scene& scene, const DeviceOptions& options) {
  FORAGER_TRY(check_air(scene));
  return std::make_unique<SimDevices>(scene, options);
}

hal::Result<std::unique_ptr<DeviceSet>> make_devices(const Scene& scene, const Board& board,
                                                     const DeviceOptions& options) {
  return board.kind == BoardKind::sim ? make_sim_devices(scene, options)
                                      : make_socket_devices(scene, board, options);
}

}  // namespace forager::boards
