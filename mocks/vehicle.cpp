#include "mocks/vehicle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace forager::mocks {
namespace {

using hal::Vec3;

constexpr double kGravity = 9.80665;
constexpr double kWindLearning = 1.0;  // s, time of the velocity loop's integrator (assumption)
// The square-root curve plans with less than the limit, so that the lagging loops behind it stay within it.
constexpr double kBrakingShare = 0.7;

struct Approach {
  double speed = 0.0;
  double slope = 0.0;  // d speed / d distance
};

// Speed at which a distance may still be approached: gain * distance near the goal, sqrt(2 a d) further off,
// joined smoothly, never above the limit (the square-root controller of ArduPilot's AC_PosControl).
Approach approach(double distance, double gain, double acceleration, double limit) {
  const double a = kBrakingShare * acceleration;
  const double linear = a / (gain * gain);
  if (distance <= linear) {
    const double speed = gain * distance;
    return speed < limit ? Approach{speed, gain} : Approach{limit, 0.0};
  }
  const double speed = std::sqrt(2.0 * a * (distance - 0.5 * linear));
  return speed < limit ? Approach{speed, a / speed} : Approach{limit, 0.0};
}

double limited(double value, double bound) { return std::clamp(value, -bound, bound); }

Vec3 limited_xy(Vec3 v, double bound) {
  const double square = v.x * v.x + v.y * v.y;
  if (square <= bound * bound) return v;
  const double k = bound / std::sqrt(square);
  return {k * v.x, k * v.y, v.z};
}

}  // namespace

Vehicle::Vehicle(const VehicleParameters& parameters, hal::Pose start)
    : parameters_(parameters), wind_random_(hal::Random::stream(parameters.seed, 0x77696E64)) {
  start.position.z = std::max(start.position.z, parameters_.floor_z_m);
  start.pitch_rad = start.roll_rad = 0.0;
  start.yaw_rad = hal::wrap_pi(start.yaw_rad);
  state_.pose = start;
  state_.on_ground = start.position.z <= parameters_.floor_z_m;
}

void Vehicle::attach(const World* world, hal::Journal* journal) {
  world_ = world;
  journal_ = journal;
  free_way_m_ = 0.0;
}

void Vehicle::stand_at(hal::Pose pose) {
  pose.position.z = parameters_.floor_z_m;
  pose.pitch_rad = pose.roll_rad = 0.0;
  state_ = {.pose = pose,
            .velocity_world_m_s = {},
            .yaw_rate_rad_s = 0.0,
            .armed = state_.armed,
            .on_ground = true};
  acceleration_ = tilt_m_s2_ = wind_felt_m_s2_ = {};
  free_way_m_ = 0.0;
}

double Vehicle::battery_v() const {
  const double open = parameters_.empty_v + battery_fraction_ * (parameters_.full_v - parameters_.empty_v);
  return open - parameters_.resistance_ohm * battery_a_;
}

void Vehicle::update(hal::Duration dt, hal::Instant now) {
  const double dt_s = hal::to_seconds(dt);
  if (!(dt_s > 0.0)) return;
  if (dt_s != step_s_) set_step(dt_s);
  state_.armed = command_.motors;
  const bool lifts = command_.motors && (command_.vertical == VehicleCommand::Follow::velocity
                                             ? command_.velocity_world_m_s.z > 0.02
                                             : command_.position_world.z > state_.pose.position.z + 0.02);
  if (state_.on_ground && !lifts) {
    state_.velocity_world_m_s = acceleration_ = tilt_m_s2_ = {};
    state_.yaw_rate_rad_s = state_.pose.pitch_rad = state_.pose.roll_rad = 0.0;
  } else {
    state_.on_ground = false;
    const Vec3 before = state_.pose.position;
    if (parameters_.wind_gust_m_s > 0.0) blow();
    if (command_.motors) {
      move(dt_s);
      turn(dt_s);
    } else {
      fall(dt_s);
    }
    if (world_ != nullptr) touch_boxes(before, now);
    if (state_.pose.position.z <= parameters_.floor_z_m) touch_floor(now);
  }
  drain(dt_s);
}

void Vehicle::set_step(double dt_s) {
  step_s_ = dt_s;
  attitude_blend_ = -std::expm1(-dt_s / parameters_.attitude_lag_s);
  wind_keep_ = std::exp(-dt_s / parameters_.wind_time_s);
  felt_blend_ = -std::expm1(-dt_s / kWindLearning);
}

// The velocity wanted now, and in `slope` the acceleration that following the braking curve needs.
Vec3 Vehicle::velocity_demand(Vec3& slope) const {
  const VehicleParameters& p = parameters_;
  const Vec3 velocity = state_.velocity_world_m_s;
  Vec3 demand = command_.velocity_world_m_s;
  slope = {};
  if (command_.horizontal == VehicleCommand::Follow::position) {
    const Vec3 way = command_.position_world - state_.pose.position;
    const double distance = std::sqrt(way.x * way.x + way.y * way.y);
    if (distance > 1e-9) {
      const Vec3 unit{way.x / distance, way.y / distance, 0.0};
      const Approach a = approach(distance, p.position_gain_1_s, p.max_acceleration_m_s2, p.max_speed_m_s);
      const double closing = (velocity.x - demand.x) * unit.x + (velocity.y - demand.y) * unit.y;
      demand = demand + a.speed * unit;
      slope = -a.slope * std::max(0.0, closing) * unit;
    }
  }
  // Where a limit decides, the curve is not followed.
  if (demand.x * demand.x + demand.y * demand.y > p.max_speed_m_s * p.max_speed_m_s) slope = {};
  demand = limited_xy(demand, p.max_speed_m_s);
  if (command_.vertical == VehicleCommand::Follow::position) {
    const double way = command_.position_world.z - state_.pose.position.z;
    const double limit = way > 0.0 ? p.max_climb_m_s : p.max_descent_m_s;
    const Approach a = approach(std::abs(way), p.position_gain_1_s, p.max_vertical_acceleration_m_s2, limit);
    const double closing = (velocity.z - demand.z) * (way > 0.0 ? 1.0 : -1.0);
    demand.z += std::copysign(a.speed, way);
    slope.z = -a.slope * std::max(0.0, closing) * (way > 0.0 ? 1.0 : -1.0);
  }
  if (demand.z < -p.max_descent_m_s || demand.z > p.max_climb_m_s) slope.z = 0.0;
  demand.z = std::clamp(demand.z, -p.max_descent_m_s, p.max_climb_m_s);
  return demand;
}

void Vehicle::move(double dt_s) {
  const VehicleParameters& p = parameters_;
  Vec3& v = state_.velocity_world_m_s;
  Vec3 slope;
  const Vec3 demand = velocity_demand(slope);
  Vec3 want = slope + (1.0 / p.velocity_lag_s) * (demand - v);
  want = limited_xy(want, p.max_acceleration_m_s2);
  want.z = limited(want.z, p.max_vertical_acceleration_m_s2);
  tilt_m_s2_ = tilt_m_s2_ + attitude_blend_ * (want - tilt_m_s2_);
  acceleration_ = tilt_m_s2_;
  // Its own drag the controller knows; of the wind it learns by its integrator.
  const Vec3 gust = p.drag_1_s * wind_m_s_;
  wind_felt_m_s2_ = wind_felt_m_s2_ + felt_blend_ * (gust - wind_felt_m_s2_);
  acceleration_ = acceleration_ + (gust - wind_felt_m_s2_);
  state_.pose.position = state_.pose.position + dt_s * v + (0.5 * dt_s * dt_s) * acceleration_;
  v = v + dt_s * acceleration_;
  tilt(tilt_m_s2_ + p.drag_1_s * Vec3{v.x, v.y, 0.0} - wind_felt_m_s2_);
}

void Vehicle::fall(double dt_s) {
  acceleration_ = {0.0, 0.0, -kGravity};
  tilt_m_s2_ = {};
  Vec3& v = state_.velocity_world_m_s;
  state_.pose.position = state_.pose.position + dt_s * v + (0.5 * dt_s * dt_s) * acceleration_;
  v = v + dt_s * acceleration_;
}

void Vehicle::turn(double dt_s) {
  const VehicleParameters& p = parameters_;
  double demand = command_.yaw_rate_rad_s;
  if (!command_.yaw_by_rate) {
    const double way = hal::angle_difference(command_.yaw_rad, state_.pose.yaw_rad);
    const Approach a =
        approach(std::abs(way), p.yaw_gain_1_s, p.max_yaw_acceleration_rad_s2, p.max_yaw_rate_rad_s);
    demand = std::copysign(a.speed, way);
  }
  demand = limited(demand, p.max_yaw_rate_rad_s);
  const double change = p.max_yaw_acceleration_rad_s2 * dt_s;
  double& rate = state_.yaw_rate_rad_s;
  const double before = rate;
  rate += limited(demand - rate, change);
  state_.pose.yaw_rad = hal::wrap_pi(state_.pose.yaw_rad + 0.5 * (before + rate) * dt_s);
}

// Thrust points along R_z(yaw) R_y(pitch) R_x(roll) e_z, hence both angles.
void Vehicle::tilt(Vec3 thrust_m_s2) {
  const Vec3 body = hal::rotate_yaw(thrust_m_s2, -state_.pose.yaw_rad);
  const double up = kGravity + body.z;
  state_.pose.pitch_rad = std::atan2(body.x, up);
  state_.pose.roll_rad = -std::atan2(body.y, std::sqrt(body.x * body.x + up * up));
}

void Vehicle::blow() {
  const double kick = parameters_.wind_gust_m_s * std::sqrt(1.0 - wind_keep_ * wind_keep_);
  wind_m_s_.x = wind_keep_ * wind_m_s_.x + kick * wind_random_.normal();
  wind_m_s_.y = wind_keep_ * wind_m_s_.y + kick * wind_random_.normal();
}

void Vehicle::touch_floor(hal::Instant now) {
  const double speed = -state_.velocity_world_m_s.z;
  state_.pose.position.z = parameters_.floor_z_m;
  state_.pose.pitch_rad = state_.pose.roll_rad = state_.yaw_rate_rad_s = 0.0;
  state_.velocity_world_m_s = acceleration_ = tilt_m_s2_ = {};
  state_.on_ground = true;
  if (speed <= parameters_.hard_landing_m_s) return;
  ++hard_landings_;
  crash(now, "hit the floor", speed);
}

// Distance from the hull to the nearest box; negative inside. Hull: upright cylinder.
double Vehicle::clearance(Vec3 at) const {
  double nearest = std::numeric_limits<double>::max();
  for (const Box& box : world_->obstacles) {
    const double dx = std::max({box.min.x - at.x, 0.0, at.x - box.max.x});
    const double dy = std::max({box.min.y - at.y, 0.0, at.y - box.max.y});
    const double across = std::sqrt(dx * dx + dy * dy) - parameters_.radius_m;
    const double above = std::max(box.min.z - at.z, at.z - box.max.z) - parameters_.half_height_m;
    nearest = std::min(nearest, std::max(across, above));
  }
  return nearest;
}

// The hull never enters a box: it stays where it was and loses its speed. The clearance found once is way
// that needs no further look.
void Vehicle::touch_boxes(Vec3 before, hal::Instant now) {
  Vec3& at = state_.pose.position;
  free_way_m_ -= std::abs(at.x - before.x) + std::abs(at.y - before.y) + std::abs(at.z - before.z);
  if (free_way_m_ > 0.0) return;
  const double clear = clearance(at);
  if (clear > 0.0) {
    free_way_m_ = clear;
    touching_ = touching_ && clear < 0.05;
    return;
  }
  if (clearance(before) <= 0.0) return;  // started inside: let it out
  const double speed = hal::norm(state_.velocity_world_m_s);
  at = before;
  state_.velocity_world_m_s = acceleration_ = tilt_m_s2_ = {};
  if (touching_) return;
  touching_ = true;
  ++collisions_;
  crash(now, "hit a box", speed);
}

void Vehicle::drain(double dt_s) {
  const VehicleParameters& p = parameters_;
  const double hover_a = p.capacity_ah * 3600.0 / p.endurance_s;
  double share = p.idle_share;
  if (!state_.on_ground && command_.motors)
    share = 1.0 + p.climb_share_s_m * std::max(0.0, state_.velocity_world_m_s.z);
  battery_a_ = hover_a * share;
  battery_fraction_ = std::max(0.0, battery_fraction_ - share * dt_s / p.endurance_s);
}

void Vehicle::crash(hal::Instant now, const char* what, double speed_m_s) {
  if (journal_ == nullptr) return;
  std::array<char, 160> line{};
  const Vec3 at = state_.pose.position;
  const auto end =
      fmt::format_to_n(line.data(), line.size(), "CRASH: {} at {:.2f} m/s, position {:.2f} {:.2f} {:.2f}",
                       what, speed_m_s, at.x, at.y, at.z);
  journal_->note(now, "vehicle", {line.data(), std::min(end.size, line.size())});
}

}  // namespace forager::mocks
