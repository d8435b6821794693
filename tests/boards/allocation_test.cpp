// From the bytes of reader and autopilot to decisions and commands without the heap: a mission in steady
// state on the emulated board, with the real drivers and codecs between.
#include <gtest/gtest.h>

#include <chrono>

#include "boards/device_set.hpp"
#include "boards/policies.hpp"
#include "boards/robot_config.hpp"
#include "boards/run.hpp"
#include "flight/mavlink_autopilot.hpp"
#include "flight/robot_loop.hpp"
#include "reader/advannet_reader.hpp"
#include "tests/boards/flown_mission.hpp"
#include "tests/reader/allocation_count.hpp"

namespace forager::boards {
namespace {

using namespace std::chrono_literals;

// Takes every batch and keeps nothing of it.
class FakeStore final : public reader::InventoryStore {
 public:
  hal::Result<> commit(std::uint64_t batch, std::span<const reader::LocatedRead> reads) override {
    last_ = batch;
    reads_ += reads.size();
    return {};
  }
  std::uint64_t last_batch() const override { return last_; }
  hal::Result<std::vector<reader::InventoryItem>> items() const override { return {}; }
  hal::Result<> set_fact(const std::string&, const std::string&) override { return {}; }
  hal::Result<std::vector<std::pair<std::string, std::string>>> facts() const override { return {}; }
  [[nodiscard]] std::uint64_t reads() const { return reads_; }

 private:
  std::uint64_t last_ = 0;
  std::uint64_t reads_ = 0;
};

// Passes on to another client and says whether an exchange is under way.
class RecordingHttp final : public hal::HttpClient {
 public:
  explicit RecordingHttp(hal::HttpClient& inner) : inner_(&inner) {}
  [[nodiscard]] bool in_flight() const { return in_flight_; }
  [[nodiscard]] std::uint64_t exchanges() const { return exchanges_; }

 private:
  hal::Result<> do_start(const hal::HttpRequest& request, hal::Instant now) override {
    in_flight_ = true;
    ++exchanges_;
    return inner_->start(request, now);
  }
  hal::Result<std::optional<hal::HttpResponse>> do_poll(hal::Instant now) override {
    auto answer = inner_->poll(now);
    in_flight_ = answer && !*answer;
    return answer;
  }
  void do_cancel() override {
    in_flight_ = false;
    inner_->cancel();
  }
  std::string_view do_name() const override { return inner_->name(); }

  hal::HttpClient* inner_;
  bool in_flight_ = false;
  std::uint64_t exchanges_ = 0;
};

// The parts of a run, put together here so that the loop can be watched by itself.
struct WatchedRun {
  explicit WatchedRun(const Scene& scene)
      : devices(make_sim_devices(scene, {.seed = 1}).value()),
        rest(devices->reader_rest()),
        reader(rest, devices->reader_events(), journal, scene.read_plan, advannet_config(scene, sim_board())),
        autopilot(flight::MavlinkAutopilot::create(devices->autopilot(), journal,
                                                   mavlink_config(scene, false), now,
                                                   flight::MotorBay().claim("autopilot").value())
                      .value()),
        policy(make_policy(scene, 1)),
        loop(robot_config(scene, devices->world()->tags.size()),
             {*autopilot, reader, devices->depth(), devices->pose(), store, journal, nullptr}, *policy) {}

  // Heap allocations of one update of the loop; the emulated devices' own life is not counted.
  std::uint64_t update() {
    now += Run::kTick;
    devices->advance(now);
    const std::uint64_t before = test::allocation_count();
    loop.update(now);
    return test::allocation_count() - before;
  }

  hal::Instant now;
  hal::NullJournal journal;
  FakeStore store;
  std::unique_ptr<DeviceSet> devices;
  RecordingHttp rest;
  reader::AdvanNetReader reader;
  std::unique_ptr<flight::Autopilot> autopilot;
  std::unique_ptr<flight::Policy> policy;
  flight::RobotLoop loop;
};

TEST(SteadyState, BytesToDecisionsToCommandsAllocateNothing) {
  WatchedRun run(published_scene("4C"));
  while (run.loop.status().window < 3 && run.now < hal::Instant(120s)) run.update();
  ASSERT_EQ(run.loop.status().phase, flight::MissionPhase::listening);

  const std::size_t decisions_before = run.loop.status().decisions.size();
  const std::uint64_t reads_before = run.loop.status().reads;
  const std::uint64_t exchanges_before = run.rest.exchanges();
  std::uint64_t in_loop = 0;
  std::uint64_t in_exchanges = 0;
  int updates_in_exchanges = 0;
  const hal::Instant end = run.now + 240s;
  while (run.now < end && !run.loop.done()) {
    const bool before = run.rest.in_flight();
    const std::uint64_t exchanges = run.rest.exchanges();
    const std::uint64_t count = run.update();
    // Asking the reader how it is makes and reads a document of text now and then: counted by itself.
    const bool in_exchange = before || run.rest.exchanges() != exchanges;
    (in_exchange ? in_exchanges : in_loop) += count;
    if (in_exchange) ++updates_in_exchanges;
  }
  EXPECT_EQ(in_loop, 0U);
  // The four minutes had work in them.
  EXPECT_GT(run.loop.status().decisions.size() - decisions_before, 15U);
  EXPECT_GT(run.loop.status().reads - reads_before, 1000U);
  EXPECT_GT(run.store.reads(), 1000U);
  EXPECT_GT(run.loop.status().path_m, 5.0);
  const std::uint64_t exchanges = run.rest.exchanges() - exchanges_before;
  RecordProperty("status_exchanges", static_cast<int>(exchanges));
  RecordProperty("allocations_in_status_exchanges", static_cast<int>(in_exchanges));
  EXPECT_LT(exchanges, 30U);
  EXPECT_LT(updates_in_exchanges, 60) << "of 12000";
  EXPECT_LT(in_exchanges, 100U * exchanges);
}

}  // namespace
}  // namespace forager::boards
