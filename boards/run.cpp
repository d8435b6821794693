#include "boards/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "boards/policies.hpp"
#include "boards/recorded_devices.hpp"
#include "boards/robot_config.hpp"
#include "boards/world_builder.hpp"
#include "flight/mavlink_autopilot.hpp"
#include "flight/robot_loop.hpp"
#include "reader/advannet_reader.hpp"

namespace forager::boards {
namespace {

// Adds the ticks a scope took to a sum.
class Stopwatch {
 public:
  Stopwatch(TickCounter counter, std::uint64_t& sum) : counter_(counter), sum_(&sum), start_(read()) {}
  ~Stopwatch() { *sum_ += read() - start_; }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  [[nodiscard]] std::uint64_t read() const { return counter_ != nullptr ? counter_() : 0; }
  TickCounter counter_;
  std::uint64_t* sum_;
  std::uint64_t start_;
};

// Everything a mission needs, in the order in which one part borrows from the one before.
class Mission final : public Run {
 public:
  Mission(const Scene& scene, const Board& board, const RunOptions& options,
          std::unique_ptr<DeviceSet> devices, std::unique_ptr<flight::Autopilot> autopilot,
          std::unique_ptr<reader::InventoryStore> store, hal::Journal& journal, hal::Instant now)
      : scene_(scene),
        board_name_(board.name),
        options_(options),
        devices_(std::move(devices)),
        autopilot_(std::move(autopilot)),
        store_(std::move(store)),
        reader_(devices_->reader_rest(), devices_->reader_events(), journal, scene.read_plan,
                advannet_config(scene, board)),
        policy_(make_policy(scene, seed_for(options.seed, SeedStream::policy))),
        loop_(robot_config(scene, tag_count()),
              flight::RobotDevices{*autopilot_, reader_, devices_->depth(), devices_->pose(), *store_,
                                   journal, &reader_.gpo(kLampLine)},
              *policy_),
        started_(now),
        ended_(now) {}

  ~Mission() override { loop_.abandon(); }

  void update(hal::Instant now) override {
    ended_ = now;
    devices_->advance(now);
    const Stopwatch stopwatch(options_.counter, loop_ticks_);
    if (loop_.done())
      reader_.update(now);  // it still owes the reader its stop
    else
      loop_.update(now);
    const bool link_up = autopilot_->state().link_up;
    if (autopilot_up_ && !link_up) ++autopilot_losses_;
    autopilot_up_ = link_up;
  }
  void halt() noexcept override { loop_.halt(); }
  void abandon() noexcept override {
    if (!abandoned_) abandoned_ = ended_;
    loop_.abandon();
  }
  bool done() const override {
    const hal::Instant since = abandoned_.value_or(loop_.status().phase_since);
    return loop_.done() && (reader_.idle() || ended_ - since > kStopAllowance);
  }
  const Scene& scene() const override { return scene_; }
  const flight::MissionStatus& status() const override { return loop_.status(); }
  const reader::LinkStatus& reader_link() const override { return reader_.link(); }
  std::span<const flight::FlownPath::Point> path() const override { return loop_.path(); }
  const WorldFacts* world() const override { return devices_->world(); }
  const reader::InventoryStore& inventory() const override { return *store_; }
  RunTicks ticks() const override { return {devices_->ticks(), loop_ticks_}; }

  std::vector<PortSummary> ports() const override {
    std::vector<PortSummary> out;
    for (const reader::ReadPort& port : scene_.read_plan.ports) {
      PortSummary summary{.port = port.port, .name = port.name, .bearing_rad = port.bearing_rad};
      for (const flight::PortTally& tally : loop_.ports()) {
        if (tally.port != port.port) continue;
        summary.reads = tally.reads;
        summary.new_tags = tally.new_tags;
      }
      out.push_back(std::move(summary));
    }
    return out;
  }

  hal::Result<RunSummary> summary() override {
    RunSummary s;
    const flight::MissionStatus& status = loop_.status();
    s.scene = scene_.name;
    s.title = scene_.title;
    s.board = board_name_;
    s.policy = std::string(to_string(scene_.mission.policy));
    s.seed = options_.seed;
    FORAGER_TRY(count_tags(s));
    s.reads = status.reads;
    s.sim_time_s = hal::to_seconds(ended_ - started_);
    if (status.took_off)
      s.flight_time_s = hal::to_seconds(status.touched_down.value_or(ended_) - *status.took_off);
    s.path_m = status.path_m;
    s.decisions = status.decisions.size();
    s.windows = status.window;
    s.end = status.end;
    if (status.detail != to_string(status.end)) s.detail = status.detail;
    s.reader_losses = reader_.link().losses;
    s.autopilot_losses = autopilot_losses_;
    s.radio_may_be_on = reader_.may_radiate();
    s.crashes = devices_->crashes();
    s.battery_fraction = status.battery_fraction;
    s.ports = ports();
    FORAGER_TRY(keep_facts(s));
    return s;
  }

 private:
  static constexpr hal::Duration kStopAllowance =
      std::chrono::seconds(10);  // for the reader to be told to stop

  // No mission reads a large world whole; what it knows of tags grows when it does.
  [[nodiscard]] std::size_t tag_count() const {
    constexpr std::size_t kUnknown = 4096;
    constexpr std::size_t kMost = 1U << 16U;
    return devices_->world() != nullptr ? std::min(devices_->world()->tags.size(), kMost) : kUnknown;
  }

  // Tags of the world that are in the inventory, wanted ones and bystanders apart.
  hal::Result<> count_tags(RunSummary& s) const {
    const WorldFacts* world = devices_->world();
    if (world == nullptr) {
      const auto items = store_->items();
      if (!items) return hal::fail(items.error());
      s.tags_read = items->size();
      return {};
    }
    const auto read = ReadTags::find(world->tags, *store_);
    if (!read) return hal::fail(read.error());
    s.tags_present = read->wanted_present;
    s.tags_read = read->wanted_read;
    s.other_tags_read = read->others_read;
    if (world->layout != nullptr) {
      const auto items = store_->items();
      if (!items) return hal::fail(items.error());
      s.layout = check_layout(*items, *world->layout);
    }
    return {};
  }

  hal::Result<> keep_facts(const RunSummary& s) {
    const std::pair<const char*, std::string> facts[] = {
        {"scene", s.scene},
        {"title", s.title},
        {"board", s.board},
        {"policy", s.policy},
        {"seed", fmt::format("{}", s.seed)},
        {"tags_present", s.tags_present ? fmt::format("{}", *s.tags_present) : std::string{}},
        {"end_reason", std::string(to_string(s.end))},
        {"sim_time_s", fmt::format("{:.2f}", s.sim_time_s)},
        {"path_m", fmt::format("{:.2f}", s.path_m)},
    };
    for (const auto& [key, value] : facts)
      if (!value.empty()) FORAGER_TRY(store_->set_fact(key, value));
    return {};
  }

  Scene scene_;
  std::string board_name_;
  RunOptions options_;
  std::unique_ptr<DeviceSet> devices_;
  std::unique_ptr<flight::Autopilot> autopilot_;
  std::unique_ptr<reader::InventoryStore> store_;
  reader::AdvanNetReader reader_;
  std::unique_ptr<flight::Policy> policy_;
  flight::RobotLoop loop_;
  hal::Instant started_;
  hal::Instant ended_;
  std::optional<hal::Instant> abandoned_;
  std::uint64_t loop_ticks_ = 0;
  bool autopilot_up_ = false;
  std::uint32_t autopilot_losses_ = 0;
};

hal::Journal& journal_of(const RunOptions& options) {
  static hal::NullJournal none;
  return options.journal != nullptr ? *options.journal : none;
}

// The read plan is what a person checks first when tags are missing.
void note_plan(const reader::ReadPlan& plan, hal::Journal& journal, hal::Instant now) {
  std::istringstream lines(to_string(plan));
  for (std::string line; std::getline(lines, line);) journal.note(now, "plan", line);
}

hal::Result<std::unique_ptr<reader::InventoryStore>> open_store(const RunOptions& options) {
  if (options.inventory_path.empty()) return reader::make_memory_inventory();
  return reader::open_sqlite_inventory(options.inventory_path, reader::StoreMode::create);
}

}  // namespace

hal::Result<std::unique_ptr<Run>> Run::prepare(const Scene& scene, const Board& board,
                                               const RunOptions& options, hal::Instant now) {
  FORAGER_TRY(validate(scene.read_plan));
  auto devices = make_devices(scene, board,
                              {.seed = options.seed,
                               .journal = options.journal,
                               .journal_wire = options.journal_wire,
                               .counter = options.counter});
  if (!devices) return hal::fail(std::move(devices).error());
  if (options.recording != nullptr) devices = record_devices(*std::move(devices), *options.recording, now);
  return prepare_with(scene, board, options, now, *std::move(devices));
}

hal::Result<std::unique_ptr<Run>> Run::prepare_with(const Scene& scene, const Board& board,
                                                    const RunOptions& options, hal::Instant now,
                                                    std::unique_ptr<DeviceSet> devices) {
  FORAGER_TRY(validate(scene.read_plan));
  FORAGER_TRY(validate(advannet_config(scene, board)));
  auto motors = flight::MotorBay().claim("autopilot");
  if (!motors) return hal::fail(std::move(motors).error());
  auto autopilot =
      flight::MavlinkAutopilot::create(devices->autopilot(), journal_of(options),
                                       mavlink_config(scene, options.journal_wire), now, std::move(*motors));
  if (!autopilot) return hal::fail(std::move(autopilot).error());
  auto store = open_store(options);
  if (!store) return hal::fail(std::move(store).error());
  note_plan(scene.read_plan, journal_of(options), now);
  return std::make_unique<Mission>(scene, board, options, std::move(devices), std::move(*autopilot),
                                   std::move(*store), journal_of(options), now);
}

}  // namespace forager::boards
