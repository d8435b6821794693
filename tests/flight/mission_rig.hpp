#pragma once

#include <cmath>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flight/robot_loop.hpp"
#include "flight/stigmergy.hpp"
#include "hal/random.hpp"
#include "hal/units.hpp"
#include "mocks/fake_digital_out.hpp"
#include "mocks/fake_pose_source.hpp"
#include "mocks/ray_cast_depth.hpp"
#include "mocks/text_journal.hpp"
#include "tests/flight/fake_autopilot.hpp"

namespace forager::flight {

inline reader::Epc epc_of(std::uint32_t number) {
  std::array<std::uint8_t, 12> bytes{};
  for (std::size_t i = 0; i < 4; ++i) bytes[8 + i] = static_cast<std::uint8_t>(number >> (24 - 8 * i));
  return *reader::Epc::from_bytes(bytes);
}

inline std::vector<reader::ReadPort> four_ports() {
  const auto port = [](std::uint8_t number, double bearing) {
    reader::ReadPort p;
    p.port = number;
    p.bearing_rad = bearing;
    return p;
  };
  return {port(4, 0.0), port(3, hal::kPi / 2), port(1, hal::kPi), port(2, -hal::kPi / 2)};
}

// A reader that hears, ten times a second and with some luck, every tag within its range by the antenna that
// looks nearest to it.
class FakeReader final : public reader::TagReader {
 public:
  explicit FakeReader(const FakeAutopilot& vehicle) : vehicle_(&vehicle) {}

  std::vector<hal::Vec3> tags;
  double range_m = 3.0;
  double luck = 0.1;
  hal::Duration delay{};  // from hearing to arriving
  reader::LinkStatus status;
  bool radiating = false;

  void lose(reader::LinkPhase phase = reader::LinkPhase::lost) {
    status.phase = phase;
    status.reason = "test took the cable out";
  }
  void recover() { status.phase = reader::LinkPhase::open; }

  void start(hal::Instant) override {
    radiating = true;
    if (status.phase == reader::LinkPhase::closed) status.phase = reader::LinkPhase::open;
  }
  void update(hal::Instant now) override {
    reads_.clear();
    for (; !on_the_way_.empty() && on_the_way_.front().arrived <= now; on_the_way_.pop_front())
      reads_.push_back(on_the_way_.front());
    if (!radiating || status.phase != reader::LinkPhase::open || now < next_) return;
    next_ = now + std::chrono::milliseconds(100);
    const hal::Pose& body = vehicle_->body;
    for (std::size_t i = 0; i < tags.size(); ++i) {
      if (hal::norm(tags[i] - body.position) > range_m || !random_.chance(luck)) continue;
      const hal::Vec3 way = tags[i] - body.position;
      const double bearing = hal::wrap_pi(std::atan2(way.y, way.x) - body.yaw_rad);
      reader::TagRead read;
      read.epc = epc_of(static_cast<std::uint32_t>(i));
      read.port = std::abs(bearing) <= hal::kPi / 4       ? std::uint8_t{4}
                  : std::abs(bearing) >= 3 * hal::kPi / 4 ? std::uint8_t{1}
                  : bearing > 0.0                         ? std::uint8_t{3}
                                                          : std::uint8_t{2};
      read.rssi_dbm = -60;
      read.heard = now;
      read.arrived = now + delay;
      delay > hal::Duration::zero() ? on_the_way_.push_back(read) : reads_.push_back(read);
    }
  }
  std::span<const reader::TagRead> reads() const override { return reads_; }
  const reader::LinkStatus& link() const override { return status; }
  void halt() noexcept override { radiating = false; }

 private:
  const FakeAutopilot* vehicle_;
  hal::Random random_{5};
  hal::Instant next_;
  std::vector<reader::TagRead> reads_;
  std::deque<reader::TagRead> on_the_way_;
};

// Passes on to a memory inventory, unless the test fills the disk.
class FaultyInventory final : public reader::InventoryStore {
 public:
  bool full = false;
  hal::Result<> commit(std::uint64_t batch, std::span<const reader::LocatedRead> reads) override {
    if (full) return hal::fail(hal::ErrorCode::io, "inventory", "commit", "disk full");
    return inner_->commit(batch, reads);
  }
  std::uint64_t last_batch() const override { return inner_->last_batch(); }
  hal::Result<std::vector<reader::InventoryItem>> items() const override { return inner_->items(); }
  hal::Result<> set_fact(const std::string& key, const std::string& value) override {
    return inner_->set_fact(key, value);
  }
  hal::Result<std::vector<std::pair<std::string, std::string>>> facts() const override {
    return inner_->facts();
  }

 private:
  std::unique_ptr<reader::InventoryStore> inner_ = reader::make_memory_inventory();
};

// Says its steps one after the other, then lands. Keeps what it was told.
class ScriptedPolicy : public Policy {
 public:
  std::vector<Step> steps;
  std::vector<Observation> seen;
  double height_m = 1.8;
  hal::Duration window = std::chrono::seconds(1);
  bool for_ever = false;  // the last step again and again

  void go(double heading_rad, double length_m) {
    Step step = step_along(heading_rad, length_m, {});
    steps.push_back(step);
  }
  Step begin(const hal::Pose& pose) override { return finish(stay_at(pose)); }
  Step decide(const Observation& observation) override {
    seen.push_back(observation);
    seen.back().weights = {};  // lives no longer than the call
    if (next_ >= steps.size() && !(for_ever && !steps.empty()))
      return finish(land_now(observation.pose_world, EndReason::path_complete));
    Step step = steps[std::min(next_, steps.size() - 1)];
    ++next_;
    step.kind = kind_of_turn(hal::angle_difference(step.heading_rad, observation.pose_world.yaw_rad));
    return finish(step);
  }
  std::string_view name() const override { return "scripted"; }

 private:
  Step finish(Step step) const {
    step.height_m = height_m;
    step.listen = window;
    return step;
  }
  std::size_t next_ = 0;
};

// A robot in a small warehouse, at 20 updates a second.
struct MissionRig : mocks::TrueBody {
  static constexpr hal::Duration kTick = std::chrono::milliseconds(50);

  explicit MissionRig(Policy& flown_policy, mocks::World place = {})
      : world(std::move(place)), camera(world, *this, depth_options(), 1), policy(flown_policy) {
    config.ports = four_ports();
  }

  const mocks::BodyState& state() const override { return body_state; }

  void make_loop() {
    loop = std::make_unique<RobotLoop>(
        config, RobotDevices{autopilot, reader, camera, pose, store, journal, &lamp}, policy);
  }
  void tick() {
    if (!loop) make_loop();
    now += kTick;
    body_state.pose = autopilot.body;
    body_state.pose.position.z += 0.2;  // the lens stands above the floor
    if (pose_good) pose.show({now, shown(autopilot.body), hal::PoseConfidence::high, pose_resets});
    lamp.tick(now);
    loop->update(now);
    if (watch) watch();
  }
  // Runs until the condition holds; false if it did not in time.
  bool run_until(const std::function<bool()>& condition, hal::Duration at_most) {
    for (const hal::Instant end = now + at_most; now < end;) {
      if (condition()) return true;
      tick();
    }
    return condition();
  }
  bool run_to(MissionPhase phase, hal::Duration at_most = std::chrono::seconds(60)) {
    return run_until([&] { return loop && loop->status().phase == phase; }, at_most);
  }
  void run(hal::Duration length) {
    run_until([] { return false; }, length);
  }
  [[nodiscard]] const MissionStatus& status() const { return loop->status(); }
  [[nodiscard]] bool on_the_ground() const {
    return autopilot.body.position.z < 0.05 && !autopilot.state().armed;
  }
  [[nodiscard]] hal::Pose shown(hal::Pose true_pose) const {
    true_pose.position = true_pose.position + pose_shift;
    return true_pose;
  }
  static mocks::SimDepthOptions depth_options() {
    mocks::SimDepthOptions options;
    options.columns = 60;
    options.rows = 40;
    options.far_as_max = true;
    return options;
  }

  mocks::World world;
  mocks::BodyState body_state;
  mocks::SimDepthCamera camera;
  Policy& policy;
  RobotLoopConfig config;
  FakeAutopilot autopilot;
  FakeReader reader{autopilot};
  mocks::FakePoseSource pose;
  bool pose_good = true;
  hal::Vec3 pose_shift;
  std::uint8_t pose_resets = 0;
  FaultyInventory store;
  mocks::TextJournal journal;
  mocks::FakeDigitalOut lamp{"lamp", &journal};
  std::unique_ptr<RobotLoop> loop;
  std::function<void()> watch;
  hal::Instant now{std::chrono::seconds(1000)};
};

}  // namespace forager::flight
