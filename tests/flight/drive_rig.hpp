#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flight/drive_loop.hpp"
#include "hal/pose_source.hpp"
#include "hal/units.hpp"
#include "mocks/fake_depth_source.hpp"
#include "mocks/fake_digital_out.hpp"
#include "mocks/text_journal.hpp"

namespace forager::flight::test {

// An autopilot on wheels that answers requests when the test lets it. What was set or asked counts as sent
// at the next update() or send().
class FakeDriveAutopilot final : public DriveAutopilot {
 public:
  // What the test sets.
  bool answers = true;  // requests; without, they stay pending
  AutopilotState said;

  // What the test reads.
  std::vector<std::string> asked;
  std::optional<AttitudeSetpoint> in_force;  // as of the last time something was sent
  std::vector<hal::PoseSample> visions;
  int halts = 0;

  void update(hal::Instant now) override {
    said.link_up = said.pose_valid = true;
    said.last_heartbeat = heard_ = now;
    if (answers && request_ == RequestState::pending) {
      if (asked.back() == "guided") said.guided = true;
      if (asked.back() == "arm") said.armed = true;
      if (asked.back() == "disarm" || asked.back() == "stop") said.armed = false;
      request_ = RequestState::accepted;
    }
    send(now);
  }
  void send(hal::Instant now) override {
    if (set_ && now >= set_->valid_until) set_.reset();
    in_force = set_;
  }
  [[nodiscard]] const AutopilotState& state() const override { return said; }
  void feed_deadman(hal::Instant) override {}
  void request_guided(hal::Instant) override { ask("guided"); }
  void request_arm(hal::Instant) override { ask("arm"); }
  void request_takeoff(double, hal::Instant) override { ask("takeoff"); }
  void request_land(hal::Instant) override { ask("land"); }
  void request_disarm(hal::Instant) override { ask("disarm"); }
  void request_stop_motors(hal::Instant) override { ask("stop"); }
  void cancel_request() override { request_ = RequestState::none; }
  [[nodiscard]] RequestState request_state() const override { return request_; }
  [[nodiscard]] const std::string& request_detail() const override { return detail_; }
  void set_position(const PositionSetpoint&) override { set_.reset(); }
  void set_velocity(const VelocitySetpoint&) override { set_.reset(); }
  void clear_setpoint() override { set_.reset(); }
  void send_vision(const hal::PoseSample& sample) override { visions.push_back(sample); }
  void halt() noexcept override { ++halts; }
  void set_attitude(const AttitudeSetpoint& setpoint) override { set_ = setpoint; }
  [[nodiscard]] std::optional<double> take_yaw_rate() override { return yaw_rate_rad_s; }
  [[nodiscard]] hal::Instant attitude_heard() const override { return heard_; }
  [[nodiscard]] bool stop_heard() const override { return false; }

  double yaw_rate_rad_s = 0.0;

 private:
  void ask(const char* what) {
    asked.emplace_back(what);
    request_ = RequestState::pending;
  }
  RequestState request_ = RequestState::none;
  std::string detail_;
  std::optional<AttitudeSetpoint> set_;
  hal::Instant heard_{hal::Instant::min()};
};

// A brake that does as it is told, until it breaks.
class FakeBrake final : public servo::BrakeActuator {
 public:
  bool broken = false;  // takes no command, and is open
  [[nodiscard]] double pressed() const { return broken ? 0.0 : told_; }
  void halt() noexcept override { told_ = 1.0; }

 private:
  hal::Result<> do_move(double fraction, hal::Instant) override {
    if (broken) return hal::fail(hal::ErrorCode::disconnected, "brake", "move", "its cable is out");
    told_ = fraction;
    return {};
  }
  [[nodiscard]] double do_commanded() const override { return told_; }
  [[nodiscard]] std::string_view do_name() const override { return "brake"; }
  double told_ = 1.0;
};

// A camera that sees the vehicle as it is.
class FakeCamera final : public hal::PoseSource {
 public:
  hal::Pose body;
  bool fails = false;
  std::optional<hal::Duration> once_ahead;  // the next stamp is this much too late

 private:
  hal::Result<std::optional<hal::PoseSample>> do_poll(hal::Instant now) override {
    if (fails) return hal::fail(hal::ErrorCode::io, "camera", "poll", "it does not answer");
    hal::PoseSample sample;
    sample.stamp = now + std::exchange(once_ahead, std::nullopt).value_or(hal::Duration::zero());
    sample.pose = body;
    sample.confidence = hal::PoseConfidence::high;
    return sample;
  }
};

// A vehicle that rolls straight on under thrust, and stops, or spins about the one wheel that is held.
struct DriveRig {
  explicit DriveRig(std::vector<servo::SteerStep> steps = {{3.0, 0.0}}, double goal_x_m = 3.0)
      : loop(DriveConfig(), DriveDevices{autopilot, camera, left, right, journal, &alive, nullptr, &depth},
             DriveMission{std::move(steps), std::nullopt,
                          DriveCorridor::create({{}, {goal_x_m, 0.0, 0.0}}, 2.0).value()},
             now) {}

  void tick() {
    now += std::chrono::milliseconds(10);
    if (shows_depth) depth.show_wall(now, kDepth, 7.0F);
    if (commands) {
      loop.feed(now);
      loop.go(now + std::chrono::milliseconds(100));
    }
    loop.update(now);
    move(0.01);
  }
  void run(hal::Duration time) {
    for (const hal::Instant end = now + time; now < end;) tick();
  }
  bool run_until(DrivePhase phase) {
    for (int i = 0; i < 1000 && loop.status().phase != phase; ++i) tick();
    return loop.status().phase == phase;
  }
  bool set_off() {
    for (int i = 0; i < 1000 && speed_m_s < 0.25; ++i) tick();
    return speed_m_s >= 0.25;
  }
  [[nodiscard]] double thrust() const {
    return autopilot.said.armed && autopilot.in_force ? autopilot.in_force->thrust : 0.0;
  }
  [[nodiscard]] bool asked_for(const char* what) const {
    return std::ranges::count(autopilot.asked, what) > 0;
  }

  static constexpr hal::DepthCameraModel kDepth{
      .columns = 64, .rows = 48, .fx_px = 34.0, .fy_px = 43.0, .cx_px = 32.0, .cy_px = 24.0};

  FakeDriveAutopilot autopilot;
  FakeCamera camera;
  FakeBrake left;
  FakeBrake right;
  mocks::TextJournal journal;
  mocks::FakeDigitalOut alive{"alive"};
  mocks::FakeDepthSource depth;
  hal::Instant now{std::chrono::seconds(10)};
  DriveLoop loop;
  double speed_m_s = 0.0;
  bool commands = true;
  bool shows_depth = true;

 private:
  void move(double dt) {
    const double held = left.pressed() + right.pressed();
    const double push = held < 0.5 ? 4.0 * thrust() : 0.0;
    const double brake = 0.1 + 1.5 * held;
    speed_m_s = std::max(0.0, speed_m_s + dt * (push - brake));
    // Pivots about the wheel that holds, half a track away.
    const double side = left.pressed() - right.pressed();
    autopilot.yaw_rate_rad_s = 2.0 * side * speed_m_s;
    camera.body.yaw_rad = hal::wrap_pi(camera.body.yaw_rad + dt * autopilot.yaw_rate_rad_s);
    camera.body.position.x += dt * speed_m_s * std::cos(camera.body.yaw_rad);
    camera.body.position.y += dt * speed_m_s * std::sin(camera.body.yaw_rad);
    most_turned_rad = std::max(most_turned_rad, std::abs(camera.body.yaw_rad));
  }

 public:
  double most_turned_rad = 0.0;
};

}  // namespace forager::flight::test
