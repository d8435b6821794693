#include "mocks/rolling_vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace forager::mocks {
namespace {

constexpr double kRest = 1e-12;  // m/s; below this a wheel that sticks stands still

struct Impulses {
  double left = 0.0;
  double right = 0.0;
};

// Two dry contacts that share one body: the impulses within +-limit that leave each wheel at rest or at its
// limit against its motion. left, right: wheel speeds without them; a: how an impulse changes its own wheel's
// speed, b: the other's (|b| < a). It is the box-bounded minimum of a convex quadratic, found by looking at
// its inside and then its edges.
Impulses solve_contacts(double left, double right, double a, double b, double most_left, double most_right) {
  const double determinant = a * a - b * b;
  const Impulses stick{(b * right - a * left) / determinant, (b * left - a * right) / determinant};
  if (std::abs(stick.left) <= most_left && std::abs(stick.right) <= most_right) return stick;
  Impulses best;
  double best_miss = std::numeric_limits<double>::infinity();
  const auto offer = [&](Impulses j) {
    const double moving_left = left + a * j.left + b * j.right;
    const double moving_right = right + b * j.left + a * j.right;
    // At its limit a wheel may move against the impulse only; inside it must stand.
    const auto miss = [](double impulse, double most, double speed) {
      if (impulse >= most) return std::max(0.0, speed);
      if (impulse <= -most) return std::max(0.0, -speed);
      return std::abs(speed);
    };
    const double total = miss(j.left, most_left, moving_left) + miss(j.right, most_right, moving_right);
    if (total < best_miss) {
      best_miss = total;
      best = j;
    }
  };
  for (const double sign : {1.0, -1.0}) {
    const double at_left = sign * most_left;
    offer({at_left, std::clamp(-(right + b * at_left) / a, -most_right, most_right)});
    const double at_right = sign * most_right;
    offer({std::clamp(-(left + b * at_right) / a, -most_left, most_left), at_right});
  }
  return best;
}

WheelState wheel_state(double speed, bool floor) {
  if (std::abs(speed) <= kRest) return WheelState::held;
  return floor ? WheelState::sliding : WheelState::rolling;
}

}  // namespace

RollingVehicle::RollingVehicle(const RollingParameters& parameters, hal::Pose start)
    : parameters_(parameters),
      left_(parameters),
      right_(parameters),
      thrust_blend_(-std::expm1(-hal::to_seconds(parameters.step) / std::max(parameters.thrust_lag_s, 1e-6))),
      pitch_blend_(-std::expm1(-hal::to_seconds(parameters.step) / std::max(parameters.pitch_lag_s, 1e-6))),
      normal_n_(parameters.mass_kg * parameters.gravity_m_s2) {
  start.yaw_rad = hal::wrap_pi(start.yaw_rad);
  state_.pose = start;
}

void RollingVehicle::update(hal::Instant now) {
  if (!started_) {
    started_ = true;
    clock_ = now;
  }
  while (clock_ + parameters_.step <= now) {
    clock_ += parameters_.step;
    step();
  }
}

void RollingVehicle::step() {
  left_.step(command_.brake_left);
  right_.step(command_.brake_right);
  const double thrust = std::isfinite(command_.thrust) ? std::clamp(command_.thrust, 0.0, 1.0) : 0.0;
  const double pitch = std::isfinite(command_.pitch_rad) ? command_.pitch_rad : 0.0;
  thrust_n_ += thrust_blend_ * (thrust_share_ * thrust * parameters_.max_thrust_n - thrust_n_);
  pitch_rad_ += pitch_blend_ * (pitch - pitch_rad_);
  drive(hal::to_seconds(parameters_.step));
}

RollingVehicle::Contact RollingVehicle::contact(double brake_n, double resistance,
                                                double wheel_normal_n) const {
  const double rolling = resistance * 0.5 * normal_n_;
  const double floor = parameters_.friction * wheel_normal_n;
  return {std::min(brake_n + rolling, floor), std::min(rolling, floor), brake_n + rolling > floor};
}

// What acts on the body as a whole; the wheels answer in settle().
void RollingVehicle::drive(double dt) {
  const RollingParameters& p = parameters_;
  const double weight = p.mass_kg * p.gravity_m_s2;
  drive_n_ = thrust_n_ * std::sin(pitch_rad_);
  normal_n_ = weight - thrust_n_ * std::cos(pitch_rad_);
  lifts_ = normal_n_ < p.least_normal_share * weight;
  normal_n_ = std::max(0.0, normal_n_);

  Push push;
  push.slope_n =
      weight * (p.grade_x * std::cos(state_.pose.yaw_rad) + p.grade_y * std::sin(state_.pose.yaw_rad));
  push.surface_n = p.surface_drag_n_s_m * speed_;
  push.torque_n_m = -drive_n_ * (p.thrust_offset_m + fault_offset_m_);
  const double yaw_rate = state_.yaw_rate_rad_s + dt * push.torque_n_m / p.yaw_inertia_kg_m2;
  const double most = p.scrub_torque_n_m * normal_n_ / weight;
  push.scrub_n_m = std::clamp(yaw_rate * p.yaw_inertia_kg_m2 / dt, -most, most);
  settle(push, dt);
}

void RollingVehicle::settle(const Push& push, double dt) {
  const RollingParameters& p = parameters_;
  const double r = p.half_track_m;
  const double force = drive_n_ - push.slope_n - push.surface_n;
  const double speed = speed_ + dt * (force / p.mass_kg + state_.yaw_rate_rad_s * side_);
  const double yaw_rate =
      state_.yaw_rate_rad_s + dt * (push.torque_n_m - push.scrub_n_m) / p.yaw_inertia_kg_m2;
  const double wheel_normal = 0.5 * (1.0 - p.front_load_share) * normal_n_;
  const Contact left =
      contact(left_.force_n(), p.rolling_resistance * (1.0 + p.drag_asymmetry), wheel_normal);
  const Contact right =
      contact(right_.force_n(), p.rolling_resistance * (1.0 - p.drag_asymmetry), wheel_normal);
  const double a = 1.0 / p.mass_kg + r * r / p.yaw_inertia_kg_m2;
  const double b = 1.0 / p.mass_kg - r * r / p.yaw_inertia_kg_m2;
  const Impulses j =
      solve_contacts(speed - r * yaw_rate, speed + r * yaw_rate, a, b, left.limit_n * dt, right.limit_n * dt);
  double new_speed = speed + (j.left + j.right) / p.mass_kg;
  double new_rate = yaw_rate + r * (j.right - j.left) / p.yaw_inertia_kg_m2;
  // What stands, stands: rounding of the impulses must not let it creep away.
  if (std::abs(new_speed) + r * std::abs(new_rate) <= kRest) new_speed = new_rate = 0.0;
  left_wheel_ = wheel_state(new_speed - r * new_rate, left.floor);
  right_wheel_ = wheel_state(new_speed + r * new_rate, right.floor);

  // Work is force times the mean of the speeds before and after: exact for a step of constant force.
  const double mean_speed = 0.5 * (speed_ + new_speed);
  const double mean_rate = 0.5 * (state_.yaw_rate_rad_s + new_rate);
  energy_.put_in += dt * (drive_n_ * mean_speed + push.torque_n_m * mean_rate);
  energy_.climbed += dt * push.slope_n * mean_speed;
  energy_.surface += dt * push.surface_n * mean_speed;
  energy_.scrub += dt * push.scrub_n_m * mean_rate;
  book_wheel(left, j.left, mean_speed - r * mean_rate);
  book_wheel(right, j.right, mean_speed + r * mean_rate);
  slide_sideways(new_rate, std::abs(j.left) + std::abs(j.right), dt);
  move(new_speed, new_rate, dt);
}

void RollingVehicle::book_wheel(const Contact& wheel, double impulse, double mean_speed) {
  const double work = -impulse * mean_speed;
  const double rolling = wheel.limit_n > 0.0 ? wheel.rolling_n / wheel.limit_n : 0.0;
  energy_.rolling += rolling * work;
  energy_.brakes += (1.0 - rolling) * work;
}

void RollingVehicle::slide_sideways(double yaw_rate, double used, double dt) {
  const RollingParameters& p = parameters_;
  const double c = std::cos(state_.pose.yaw_rad);
  const double s = std::sin(state_.pose.yaw_rad);
  const double slope = p.gravity_m_s2 * (p.grade_y * c - p.grade_x * s);
  const double free = side_ - dt * (slope + yaw_rate * speed_);
  const double grip = p.friction * (1.0 - p.front_load_share) * normal_n_ * dt;
  const double left_over = std::sqrt(std::max(0.0, grip * grip - used * used)) / p.mass_kg;
  const double before = side_;
  side_ = free - std::clamp(free, -left_over, left_over);
  energy_.scrub += p.mass_kg * (free - side_) * 0.5 * (before + side_);
}

void RollingVehicle::move(double speed, double yaw_rate, double dt) {
  const double mean_speed = 0.5 * (speed_ + speed);
  const double turn = 0.5 * (state_.yaw_rate_rad_s + yaw_rate) * dt;
  const double heading = state_.pose.yaw_rad + 0.5 * turn;
  const double c = std::cos(heading);
  const double s = std::sin(heading);
  state_.pose.position.x += dt * (mean_speed * c - side_ * s);
  state_.pose.position.y += dt * (mean_speed * s + side_ * c);
  state_.pose.yaw_rad = hal::wrap_pi(state_.pose.yaw_rad + turn);
  state_.pose.pitch_rad = pitch_rad_;
  state_.yaw_rate_rad_s = yaw_rate;
  speed_ = speed;
  state_.velocity_world_m_s = {speed * c - side_ * s, speed * s + side_ * c, 0.0};
}

void RollingVehicle::stand_at(hal::Pose pose) {
  pose.position.z = pose.pitch_rad = pose.roll_rad = 0.0;
  state_ = {.pose = pose,
            .velocity_world_m_s = {},
            .yaw_rate_rad_s = 0.0,
            .armed = state_.armed,
            .on_ground = true};
  command_.thrust = command_.pitch_rad = 0.0;
  thrust_n_ = pitch_rad_ = drive_n_ = speed_ = side_ = 0.0;
}

void RollingVehicle::set_motion(double speed_m_s, double yaw_rate_rad_s) {
  speed_ = speed_m_s;
  state_.yaw_rate_rad_s = yaw_rate_rad_s;
}

double RollingVehicle::kinetic_j() const {
  const double rate = state_.yaw_rate_rad_s;
  return 0.5 * (parameters_.mass_kg * (speed_ * speed_ + side_ * side_) +
                parameters_.yaw_inertia_kg_m2 * rate * rate);
}

}  // namespace forager::mocks
