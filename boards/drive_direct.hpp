#pragma once

#include <optional>
#include <string>

#include "boards/drive_plant.hpp"
#include "flight/drive_autopilot.hpp"
#include "hal/digital_out.hpp"
#include "hal/random.hpp"
#include "mocks/rolling_vehicle.hpp"
#include "servo/brake_actuator.hpp"

namespace forager::boards {

// An autopilot and two brakes on an emulated vehicle without wire bytes between: for thousands of seeded
// runs. What matters for control and safety is kept: gyro noise, the autopilot's time-out (it then levels the
// body and leaves thrust as it is), arming, a link that can be cut, brakes that lock by themselves when
// nobody commands any more. `forager drive --wire` runs the same loop through all bytes.
class DirectAutopilot final : public flight::DriveAutopilot {
 public:
  DirectAutopilot(mocks::RollingVehicle& vehicle, const DriveScene& scene, const DrivePlantDraw& draw,
                  std::uint64_t seed);

  // The emulated side: what the autopilot does with what it was told. Call it also when nobody commands.
  void run(hal::Instant now);
  void cut_link(bool cut) { cut_ = cut; }
  void take_over() { pilot_ = true; }       // a pilot leaves GUIDED
  void arm_by_hand() { armed_ = true; }     // somebody else arms it
  void tell_stop() { stop_heard_ = true; }  // a ground station does

  [[nodiscard]] double thrust() const { return armed_ ? thrust_ : 0.0; }
  [[nodiscard]] double pitch_rad() const { return pitch_; }

  void update(hal::Instant now) override;
  [[nodiscard]] const flight::AutopilotState& state() const override { return state_; }
  void feed_deadman(hal::Instant) override {}
  void request_guided(hal::Instant) override { ask(Ask::guided); }
  void request_arm(hal::Instant) override { ask(Ask::arm); }
  void request_takeoff(double, hal::Instant) override { request_ = flight::RequestState::refused; }
  void request_land(hal::Instant) override { ask(Ask::disarm); }
  void request_disarm(hal::Instant) override { ask(Ask::disarm); }
  void cancel_request() override {
    asked_ = Ask::none;
    request_ = flight::RequestState::none;
  }
  [[nodiscard]] flight::RequestState request_state() const override { return request_; }
  [[nodiscard]] const std::string& request_detail() const override { return detail_; }
  void set_position(const flight::PositionSetpoint&) override { told_.reset(); }
  void set_velocity(const flight::VelocitySetpoint&) override { told_.reset(); }
  void clear_setpoint() override { told_.reset(); }
  void send_vision(const hal::PoseSample&) override {}
  void halt() noexcept override { ask(Ask::disarm); }
  void set_attitude(const flight::AttitudeSetpoint& setpoint) override {
    told_ = setpoint;
    fresh_ = true;
  }
  [[nodiscard]] std::optional<double> take_yaw_rate() override;
  [[nodiscard]] hal::Instant attitude_heard() const override { return heard_; }
  [[nodiscard]] bool stop_heard() const override { return stop_heard_; }
  void request_stop_motors(hal::Instant) override { ask(Ask::disarm); }
  void send(hal::Instant) override {}  // nothing lies between: heard at the next run()

 private:
  enum class Ask : std::uint8_t { none, guided, arm, disarm };
  void ask(Ask what) noexcept {
    asked_ = what;
    request_ = flight::RequestState::pending;
  }

  mocks::RollingVehicle* vehicle_;
  hal::Random random_;
  double gyro_noise_;
  double gyro_bias_;
  hal::Duration timeout_;
  flight::AutopilotState state_;
  flight::RequestState request_ = flight::RequestState::none;
  std::string detail_ = "not for a vehicle on wheels";
  Ask asked_ = Ask::none;
  std::optional<flight::AttitudeSetpoint> told_;
  bool fresh_ = false;  // not yet heard
  hal::Instant told_at_;
  double thrust_ = 0.0;  // the autopilot's own, of its newest message
  double pitch_ = 0.0;
  bool armed_ = false;
  bool cut_ = false;
  bool pilot_ = false;
  bool stop_heard_ = false;
  hal::Instant heard_{hal::Instant::min()};
  hal::Instant next_attitude_{hal::Instant::min()};
  std::optional<double> yaw_rate_;
};

// A brake's output: what it was last told.
class DirectBrake final : public servo::BrakeActuator {
 public:
  explicit DirectBrake(std::string name) : name_(std::move(name)) {}
  [[nodiscard]] double demand() const { return told_; }
  void halt() noexcept override { told_ = 1.0; }

 private:
  hal::Result<> do_move(double fraction, hal::Instant now) override;
  [[nodiscard]] double do_commanded() const override { return told_; }
  [[nodiscard]] std::string_view do_name() const override { return name_; }

  std::string name_;
  double told_ = 1.0;
};

// A retriggered watchdog between the brakes' outputs and the servos: when its line stops changing it locks
// both brakes, whatever the outputs say.
class BrakeKeeper final : public hal::DigitalOut {
 public:
  explicit BrakeKeeper(hal::Duration allowed) : allowed_(allowed) {}
  void tick(hal::Instant now) { now_ = now; }
  [[nodiscard]] bool locks() const { return now_ - changed_ > allowed_; }
  [[nodiscard]] double demand(double told) const { return locks() ? 1.0 : told; }

 private:
  hal::Result<> do_set(bool active) override;
  [[nodiscard]] std::string_view do_name() const override { return "brake keeper"; }

  hal::Duration allowed_;
  hal::Instant now_{};
  hal::Instant changed_{};
  bool level_ = false;
};

}  // namespace forager::boards
