#include "boards/drive_run.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "boards/drive_judge.hpp"
#include "boards/drive_rig.hpp"
#include "hal/units.hpp"

namespace forager::boards {
namespace {

using hal::Instant;

constexpr hal::Duration kTick = std::chrono::milliseconds(10);
constexpr double kTrackEvery = 0.1;  // s
constexpr double kAfter = 8.0;       // s, for a vehicle that does not come to a stand
constexpr double kMoving = 0.12;     // m/s and rad/s: a fault strikes what moves
constexpr hal::Duration kGo = std::chrono::milliseconds(100);  // life of the mission's command

constexpr std::array<std::string_view, kDriveFaults> kFaults{
    "none",           "left_stuck_here", "right_stuck_here", "left_stuck_locked", "right_stuck_locked",
    "left_open",      "right_open",      "pose_lost",        "pose_silent",       "link_lost",
    "command_stale",  "watch_lost",      "process_killed",   "slippery",          "motors_dead",
    "one_motor_dead", "stop_button",     "stop_link"};

class Runner {
 public:
  Runner(const DriveScene& scene, const DriveRunOptions& options, DriveRig& rig, flight::DriveMission mission,
         hal::Journal& journal)
      : scene_(&scene),
        options_(options),
        rig_(&rig),
        loop_(scene.drive, rig.devices(journal), std::move(mission), Instant{}),
        judge_(scene, loop_.mission().corridor, result_) {
    result_.seed = options.seed;
    result_.clearance_m = std::numeric_limits<double>::infinity();
    result_.steps = loop_.mission().steps.size();
  }

  DriveResult run() {
    Instant now{};
    for (; !over(now); now += kTick) {
      rig_->advance(now);
      judge_.look(*rig_, hal::to_seconds(now));
      strike(now);
      if (!killed_) command(now);
      keep_track(now);
    }
    judge_.close(*rig_, hal::to_seconds(now));
    result_.end = loop_.status().end;
    result_.detail = loop_.status().detail;
    result_.steps_done = loop_.steer().step() + (result_.end == flight::DriveEnd::arrived ? 1U : 0U);
    result_.stats = loop_.steer().stats();
    result_.learnt = loop_.steer().learnt();
    return std::move(result_);
  }

 private:
  void command(Instant now) {
    const bool stale = result_.struck_s && options_.fault == DriveFault::command_stale;
    const bool unwatched = result_.struck_s && options_.fault == DriveFault::watch_lost;
    if (!unwatched) loop_.feed(now);
    if (!stale) loop_.go(now + kGo);
    loop_.update(now);
    if (!result_.struck_s) return;
    // Where the answer to the fault is to wait and not to end, waiting is what shows that it was noticed.
    const bool waits = options_.fault == DriveFault::pose_lost || options_.fault == DriveFault::pose_silent ||
                       options_.fault == DriveFault::command_stale;
    const bool ended = loop_.status().stopped_from && loop_.status().end != flight::DriveEnd::arrived;
    if (ended || (waits && !loop_.interlocks().may_thrust())) judge_.detected(hal::to_seconds(now));
  }

  void strike(Instant now) {
    const double now_s = hal::to_seconds(now);
    const bool due = options_.fault != DriveFault::none && !result_.struck_s &&
                     loop_.status().phase == flight::DrivePhase::driving && now_s >= options_.fault_s;
    if (due) {
      const mocks::BodyState& body = rig_->vehicle().state();
      if (norm(body.velocity_world_m_s) < kMoving && std::abs(body.yaw_rate_rad_s) < kMoving) return;
      judge_.struck(options_.fault, now_s);
      killed_ = options_.fault == DriveFault::process_killed;
      rig_->strike(options_.fault, now);
    }
    // Nobody of ours notices its own death: the first time-out of what is left does.
    if (killed_ && now_s >= *result_.struck_s + std::min(scene_->keeper_s, scene_->guided_timeout_s))
      judge_.detected(now_s);
  }

  bool over(Instant now) {
    const double now_s = hal::to_seconds(now);
    if (now_s > scene_->time_limit_s) {
      result_.hung = !loop_.done();
      return true;
    }
    const bool stopped =
        loop_.done() || killed_ ||
        (result_.detected_s && result_.safe_s && options_.fault == DriveFault::command_stale);
    if (!stopped) {
      ended_s_.reset();
      return false;
    }
    if (!ended_s_) ended_s_ = now_s;
    const bool safe = !result_.detected_s || result_.safe_s;
    return now_s - *ended_s_ > kAfter || (now_s - *ended_s_ > 1.0 && judge_.stands() && safe);
  }

  void keep_track(Instant now) {
    const double now_s = hal::to_seconds(now);
    if (!options_.keep_track || now_s < next_track_s_) return;
    next_track_s_ = now_s + kTrackEvery;
    const hal::Pose& at = rig_->vehicle().state().pose;
    result_.track.push_back({now_s, at.position.x, at.position.y, at.yaw_rad});
  }

  const DriveScene* scene_;
  DriveRunOptions options_;
  DriveRig* rig_;
  flight::DriveLoop loop_;
  DriveResult result_;
  DriveJudge judge_;
  std::optional<double> ended_s_;
  double next_track_s_ = 0.0;
  bool killed_ = false;
};

}  // namespace

std::string_view to_string(DriveFault fault) { return kFaults[static_cast<std::size_t>(fault)]; }

bool DriveResult::arrived(const DriveScene& scene) const {
  return end == flight::DriveEnd::arrived && stands && !left_corridor && clearance_m > 0.0 &&
         position_error_m <= scene.steps.goal_margin_m && heading_error_rad <= scene.steps.heading_margin_rad;
}

std::optional<double> DriveResult::reaction_s() const {
  if (!detected_s || !safe_s) return std::nullopt;
  return *safe_s - *detected_s;
}

hal::Result<flight::DriveMission> drive_mission(const DriveScene& scene) {
  const auto steps = servo::path_steps(scene.path, scene.steps);
  if (!steps) return hal::fail(steps.error());
  std::vector<servo::SteerStep> targets;
  std::vector<hal::Vec3> line{{scene.path.front().x_m, scene.path.front().y_m, 0.0}};
  for (const servo::PathStep& step : *steps) {
    targets.push_back({step.x_m, step.y_m});
    line.push_back({step.x_m, step.y_m, 0.0});
  }
  auto corridor = flight::DriveCorridor::create(std::move(line), scene.corridor_half_width_m);
  if (!corridor) return hal::fail(std::move(corridor).error());
  return flight::DriveMission{std::move(targets), scene.goal_heading_rad, std::move(*corridor)};
}

hal::Result<DriveResult> run_drive(const DriveScene& scene, const DriveRunOptions& options) {
  auto mission = drive_mission(scene);
  if (!mission) return hal::fail(std::move(mission).error());
  hal::NullJournal nobody;
  hal::Journal& journal = options.journal != nullptr ? *options.journal : nobody;
  auto rig =
      options.wire ? make_wire_rig(scene, options.seed, journal) : make_direct_rig(scene, options.seed);
  if (!rig) return hal::fail(std::move(rig).error());
  return Runner(scene, options, **rig, std::move(*mission), journal).run();
}

}  // namespace forager::boards
