#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "flight/autopilot.hpp"
#include "hal/units.hpp"

namespace forager::flight {

// An autopilot and its vehicle in one: accepts or refuses as told, and moves with limited speed, acceleration
// and yaw rate. A test looks at where the body is and at everything that was asked of it.
class FakeAutopilot final : public Autopilot {
 public:
  // What the test sets.
  bool link_up = true;
  bool refuse_guided = false;
  bool refuse_arm = false;
  bool refuse_takeoff = false;
  bool ignore_arm = false;  // the request stays under way
  bool frozen = false;      // takes setpoints but does not move
  double max_speed_m_s = 1.0;
  double acceleration_m_s2 = 1.5;
  double yaw_rate_rad_s = 1.0;

  // What the test reads.
  hal::Pose body;
  hal::Vec3 velocity;
  std::vector<std::string> asked;
  std::uint32_t setpoints = 0;
  std::uint32_t visions = 0;
  std::uint8_t vision_resets = 0;  // changes of the reset counter it was given
  std::uint32_t feeds = 0;
  std::optional<PositionSetpoint> goal;

  void pilot_takes_over(std::uint32_t mode = 5) {
    state_.custom_mode = mode;
    state_.guided = false;
    landing_ = false;
  }
  void set_battery(double fraction) { state_.battery_fraction = fraction; }
  void disarm() { state_.armed = false; }
  void preset_armed() { state_.armed = true; }

  void update(hal::Instant now) override {
    const double dt = last_ ? hal::to_seconds(now - *last_) : 0.0;
    last_ = now;
    if (link_up) state_.last_heartbeat = now;
    state_.link_up = link_up;
    if (goal && now > goal->valid_until) goal.reset();
    fly(dt);
    state_.pose_valid = link_up;
    state_.pose_world = body;
    state_.velocity_world_m_s = velocity;
    state_.in_air = body.position.z > 0.05;
    if (landing_ && !state_.in_air) state_.armed = false;
  }
  const AutopilotState& state() const override { return state_; }
  void feed_deadman(hal::Instant) override { ++feeds; }

  void request_guided(hal::Instant) override {
    answer("guided", refuse_guided, [&] { state_.guided = true; });
  }
  void request_arm(hal::Instant) override {
    if (ignore_arm) {
      asked.emplace_back("arm");
      request_ = RequestState::pending;
      return;
    }
    answer("arm", refuse_arm, [&] { state_.armed = true; });
  }
  void request_takeoff(double height_m, hal::Instant) override {
    answer("takeoff", refuse_takeoff, [&] { climb_to_ = body.position.z + height_m; });
  }
  void request_land(hal::Instant) override {
    answer("land", false, [&] {
      landing_ = true;
      state_.guided = false;
      state_.custom_mode = 9;
    });
  }
  void request_disarm(hal::Instant) override {
    answer("disarm", state_.in_air, [&] { state_.armed = false; });
  }
  void cancel_request() override {
    asked.emplace_back("cancel");
    request_ = RequestState::none;
  }
  RequestState request_state() const override { return request_; }
  const std::string& request_detail() const override { return detail_; }

  void set_position(const PositionSetpoint& setpoint) override {
    ++setpoints;
    goal = setpoint;
  }
  void set_velocity(const VelocitySetpoint&) override { ++setpoints; }
  void clear_setpoint() override { goal.reset(); }
  void send_vision(const hal::PoseSample& sample) override {
    if (visions++ > 0 && sample.reset_counter != vision_counter_) ++vision_resets;
    vision_counter_ = sample.reset_counter;
  }
  void halt() noexcept override { asked.emplace_back("halt"); }

 private:
  template <class Effect>
  void answer(const char* what, bool refuse, Effect effect) {
    asked.emplace_back(what);
    if (!link_up) {
      request_ = RequestState::pending;
      return;
    }
    request_ = refuse ? RequestState::refused : RequestState::accepted;
    detail_ = refuse ? std::string(what) + " refused: PreArm: test" : "";
    if (!refuse) effect();
  }

  void fly(double dt) {
    hal::Vec3 wanted;
    if (state_.armed && landing_) {
      wanted = {0.0, 0.0, -0.7};
    } else if (state_.armed && state_.guided && goal && body.position.z > 0.3) {
      climb_to_.reset();
      wanted = goal->position_world - body.position;
      const double turn = hal::angle_difference(goal->yaw_rad, body.yaw_rad);
      if (!frozen)
        body.yaw_rad =
            hal::wrap_pi(body.yaw_rad + std::clamp(turn, -yaw_rate_rad_s * dt, yaw_rate_rad_s * dt));
    } else if (state_.armed && climb_to_) {
      wanted = {0.0, 0.0, *climb_to_ - body.position.z};
    }
    if (frozen) wanted = {};
    const double speed = hal::norm(wanted);
    if (speed > max_speed_m_s) wanted = (max_speed_m_s / speed) * wanted;
    const hal::Vec3 change = wanted - velocity;
    const double most = acceleration_m_s2 * dt;
    const double length = hal::norm(change);
    velocity = velocity + (length > most ? most / length : 1.0) * change;
    body.position = body.position + dt * velocity;
    body.position.z = std::max(0.0, body.position.z);
  }

  AutopilotState state_;
  RequestState request_ = RequestState::none;
  std::string detail_;
  std::optional<hal::Instant> last_;
  std::optional<double> climb_to_;
  bool landing_ = false;
  std::uint8_t vision_counter_ = 0;
};

}  // namespace forager::flight
