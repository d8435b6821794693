#include <algorithm>
#include <cmath>

#include "boards/calibration.hpp"
#include "boards/sim_air.hpp"
#include "boards/world_builder.hpp"
#include "mocks/body.hpp"
#include "mocks/gen2_field.hpp"

namespace forager::boards {
namespace {

constexpr double kTick_s = 0.02;
constexpr double kPoseEvery_s = 0.1;

// A body on rails: from waypoint to waypoint and back, looking where its scene starts it, never stopping.
class CarriedBody final : public mocks::TrueBody {
 public:
  explicit CarriedBody(const Scene& scene) : speed_m_s_(scene.mission.speed_m_s) {
    stations_.push_back(scene.vehicle.start.position);
    for (const hal::Vec3& waypoint : scene.mission.waypoints) stations_.push_back(waypoint);
    for (hal::Vec3& station : stations_) station.z = scene.vehicle.altitude_m;
    for (std::size_t i = 1; i < stations_.size(); ++i) length_m_ += norm(stations_[i] - stations_[i - 1]);
    state_.pose = scene.vehicle.start;
    move_to(0.0);
  }

  void move_to(double time_s) {
    double way = length_m_ > 0.0 ? std::fmod(speed_m_s_ * time_s, 2.0 * length_m_) : 0.0;
    if (way > length_m_) way = 2.0 * length_m_ - way;
    state_.pose.position = stations_.front();
    for (std::size_t i = 1; i < stations_.size(); ++i) {
      const hal::Vec3 leg = stations_[i] - stations_[i - 1];
      const double leg_m = norm(leg);
      if (leg_m <= 0.0) continue;
      state_.pose.position = stations_[i - 1] + std::min(way / leg_m, 1.0) * leg;
      if (way <= leg_m) return;
      way -= leg_m;
    }
  }
  [[nodiscard]] const mocks::BodyState& state() const override { return state_; }

 private:
  double speed_m_s_;
  double length_m_ = 0.0;
  std::vector<hal::Vec3> stations_;
  mocks::BodyState state_;
};

mocks::RadioSettings settings_of(const reader::ReadPlan& plan) {
  mocks::RadioSettings settings;
  settings.session = static_cast<int>(plan.session);
  settings.on_time = plan.on_time;
  settings.off_time = plan.off_time;
  for (const reader::ReadPort& port : plan.ports)
    settings.ports.push_back({port.port, port.power_dbm.value_or(plan.power_dbm),
                              port.sensitivity_dbm.value_or(plan.sensitivity_dbm)});
  return settings;
}

constexpr std::uint32_t kUnlisted = 0xFFFFFFFF;

// Where in the list each tag of the world stands.
std::vector<std::uint32_t> places_in(const mocks::TagLayout& layout, std::size_t tags) {
  std::vector<std::uint32_t> places(tags, 0);
  for (const std::uint32_t tag : layout.unlisted) places[tag] = kUnlisted;
  std::uint32_t next = 0;
  for (std::uint32_t& place : places)
    if (place != kUnlisted) place = next++;
  return places;
}

}  // namespace

hal::Result<Recording> simulate_recording(const Scene& scene, std::uint64_t seed, double seconds) {
  if (auto valid = validate(air_of(scene), antennas_of(scene)); !valid)
    return hal::fail(std::move(valid).error());
  const mocks::World world = build_world(scene, seed);
  CarriedBody body(scene);
  mocks::SimTagField field(world, body, antennas_of(scene), air_of(scene), seed_for(seed, SeedStream::air));
  Recording recording;
  const mocks::TagLayout layout = build_layout(scene, world, seed);
  const std::vector<std::uint32_t> listed = places_in(layout, world.tags.size());
  for (std::size_t tag = 0; tag < layout.tags.size(); ++tag)
    recording.tags.push_back({layout.tags.epc_hex(tag), layout.tags.position(tag)});
  field.radio_on(settings_of(scene.read_plan), hal::Instant{});
  std::vector<mocks::AirRead> heard;
  double next_pose_s = 0.0;
  const auto ticks = static_cast<long>(std::ceil(seconds / kTick_s));
  for (long tick = 0; tick <= ticks; ++tick) {
    const double now_s = static_cast<double>(tick) * kTick_s;
    body.move_to(now_s);
    heard.clear();
    field.advance(hal::Instant{} + hal::from_seconds(now_s), heard);
    for (const mocks::AirRead& read : heard) {
      if (listed[read.tag] == kUnlisted)
        ++recording.strangers;
      else
        recording.reads.push_back({hal::to_seconds(read.at - hal::Instant{}), listed[read.tag], read.port,
                                   static_cast<double>(read.rssi_dbm)});
    }
    if (now_s < next_pose_s && tick != ticks) continue;
    recording.poses.push_back({now_s, body.state().pose});
    next_pose_s += kPoseEvery_s;
  }
  return recording;
}

}  // namespace forager::boards
