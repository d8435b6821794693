#include "boards/hybrid_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "boards/drive_rig.hpp"
#include "flight/drive_ground.hpp"
#include "hal/units.hpp"

namespace forager::boards {
namespace {

using hal::Instant;

constexpr hal::Duration kTick = std::chrono::milliseconds(10);
constexpr double kTrackEvery = 0.1;  // s
constexpr double kAirborne = 0.02;   // m
constexpr double kPressed = 0.5;     // of a brake's travel
constexpr double kStandsAfter_s = 1.0;

flight::HybridConfig mode_config(const HybridScene& scene) {
  flight::HybridConfig config;
  config.hop = scene.route.hop;
  config.flight.speed_m_s = scene.flight_m_s;
  return config;
}

flight::DriveGroundConfig ground_config(const HybridScene& scene) {
  flight::DriveGroundConfig config;
  config.drive = scene.drive.drive;
  config.step_m = 0.5 * (scene.drive.steps.min_step_m + scene.drive.steps.max_step_m);
  config.corridor_half_width_m = scene.drive.corridor_half_width_m;
  return config;
}

double distance_to(hal::Vec3 at, const flight::HopObstacle& o) {
  return std::hypot(std::max(std::abs(at.x - o.centre_world.x) - o.half_x_m, 0.0),
                    std::max(std::abs(at.y - o.centre_world.y) - o.half_y_m, 0.0));
}

// Holds the vehicle's true way against the obstacles.
class Judge {
 public:
  Judge(const HybridScene& scene, HybridResult& result) : scene_(&scene), result_(&result) {
    result.side_clearance_m = result.over_clearance_m = std::numeric_limits<double>::infinity();
  }

  void look(DriveRig& rig) {
    const mocks::BodyState& body = rig.body();
    const hal::Vec3 at = body.pose.position;
    const bool airborne = at.z > kAirborne;
    if (seen_) (airborne ? result_->flown_m : result_->rolled_m) += hal::distance_xy(at, last_);
    last_ = at;
    seen_ = true;
    result_->highest_m = std::max(result_->highest_m, at.z);
    if (airborne) result_->airborne_s += hal::to_seconds(kTick);
    const bool pressed =
        rig.vehicle().command().brake_left >= kPressed && rig.vehicle().command().brake_right >= kPressed;
    if (airborne && !pressed) result_->braked_in_air = false;
    for (const flight::HopObstacle& o : scene_->obstacles) look_at(at, o);
    stands_ = !body.armed && body.on_ground && hal::norm(body.velocity_world_m_s) < 0.02;
  }
  [[nodiscard]] bool stands() const { return stands_; }
  [[nodiscard]] hal::Vec3 at() const { return last_; }

 private:
  void look_at(hal::Vec3 at, const flight::HopObstacle& o) {
    const double side = distance_to(at, o) - scene_->drive.body_half_width_m;
    const double top = o.height_m.value_or(std::numeric_limits<double>::infinity());
    if (at.z < top + 0.5 * scene_->route.hop.height_margin_m)
      result_->side_clearance_m = std::min(result_->side_clearance_m, side);
    if (side < 0.0) result_->over_clearance_m = std::min(result_->over_clearance_m, at.z - top);
  }

  const HybridScene* scene_;
  HybridResult* result_;
  hal::Vec3 last_;
  bool seen_ = false;
  bool stands_ = false;
};

class Runner {
 public:
  Runner(const HybridScene& scene, const HybridRunOptions& options, DriveRig& rig, flight::HybridRoute route,
         hal::Journal& journal)
      : scene_(&scene),
        options_(options),
        rig_(&rig),
        vision_(scene.drive.drive.vision),
        devices_(rig.devices(journal)),
        ground_(ground_config(scene), with_vision(devices_)),
        mode_(mode_config(scene), {devices_.autopilot, ground_, devices_.pose, vision_, journal}, route,
              scene.obstacles, Instant{}),
        judge_(scene, result_) {
    result_.seed = options.seed;
    result_.route = std::move(route);
  }

  HybridResult run() {
    Instant now{};
    double ended_s = 0.0;
    for (;; now += kTick) {
      const double now_s = hal::to_seconds(now);
      rig_->advance(now);
      judge_.look(*rig_);
      strike(now);
      mode_.update(now);
      keep_track(now_s);
      if (!mode_.done()) ended_s = now_s;
      result_.hung = now_s > scene_->drive.time_limit_s;
      if (result_.hung || (judge_.stands() && now_s - ended_s > kStandsAfter_s)) break;
    }
    result_.time_s = ended_s;
    result_.end = mode_.status().end;
    result_.detail = mode_.status().detail;
    result_.hops = mode_.status().hops;
    result_.stands = judge_.stands();
    result_.position_error_m = hal::distance_xy(judge_.at(), scene_->places.back());
    return std::move(result_);
  }

 private:
  [[nodiscard]] flight::DriveDevices with_vision(flight::DriveDevices devices) {
    devices.vision = &vision_;
    return devices;
  }
  void strike(Instant now) {
    if (options_.fault == DriveFault::none || struck_ || mode_.status().phase != flight::HybridPhase::flying)
      return;
    if (hal::norm(rig_->body().velocity_world_m_s) < 0.5 * scene_->flight_m_s) return;
    struck_ = true;
    rig_->strike(options_.fault, now);
  }
  void keep_track(double now_s) {
    if (!options_.keep_track || now_s < next_track_s_) return;
    next_track_s_ = now_s + kTrackEvery;
    const hal::Pose& at = rig_->body().pose;
    result_.track.push_back({now_s, at.position, at.yaw_rad, at.position.z > kAirborne});
  }

  const HybridScene* scene_;
  HybridRunOptions options_;
  DriveRig* rig_;
  flight::VisionFilter vision_;
  flight::DriveDevices devices_;
  flight::DriveGround ground_;
  flight::HybridMode mode_;
  HybridResult result_;
  Judge judge_;
  double next_track_s_ = 0.0;
  bool struck_ = false;
};

}  // namespace

bool HybridResult::arrived(const HybridScene& scene) const {
  return end == flight::HybridEnd::arrived && stands && braked_in_air && side_clearance_m > 0.0 &&
         over_clearance_m > 0.0 && position_error_m <= scene.drive.steps.goal_margin_m;
}

hal::Result<HybridResult> run_hybrid(const HybridScene& scene, const HybridRunOptions& options) {
  const flight::EnergyModel energy(scene.energy);
  auto route =
      flight::plan_route(scene.places, scene.drive.start.yaw_rad, scene.obstacles, scene.route, energy);
  if (!route) return hal::fail(std::move(route).error());
  hal::NullJournal nobody;
  hal::Journal& journal = options.journal != nullptr ? *options.journal : nobody;
  auto rig = make_wire_rig(scene.drive, options.seed, journal);
  if (!rig) return hal::fail(std::move(rig).error());
  return Runner(scene, options, **rig, *std::move(route), journal).run();
}

std::vector<std::string> describe_route(const HybridScene& scene, const flight::HybridRoute& route) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < route.choices.size(); ++i) {
    const flight::HybridChoice& choice = route.choices[i];
    std::string line = fmt::format("stretch {}: {}, {}", i + 1, choice.hops ? "hops" : "rolls", choice.why);
    if (choice.can_roll)
      line += fmt::format("; on the ground about {:.0f} s and {:.0f} J", choice.rolling.time_s,
                          choice.rolling.energy_j);
    if (choice.can_hop)
      line += fmt::format("; with the hop about {:.0f} s and {:.0f} J", choice.hopping.time_s,
                          choice.hopping.energy_j);
    lines.push_back(std::move(line));
  }
  for (const flight::HybridLeg& leg : route.legs)
    if (leg.kind == flight::HybridLeg::Kind::hop)
      lines.push_back(
          fmt::format("hop from ({:.2f}, {:.2f}) to ({:.2f}, {:.2f}), wheels {:.2f} m up, over {:.2f} m",
                      leg.hop.takeoff_world.x, leg.hop.takeoff_world.y, leg.hop.landing_world.x,
                      leg.hop.landing_world.y, leg.hop.climb_m, leg.hop.highest_m));
  for (const std::string& line : flight::EnergyModel(scene.energy).assumptions())
    lines.push_back("assumed: " + line);
  return lines;
}

}  // namespace forager::boards
