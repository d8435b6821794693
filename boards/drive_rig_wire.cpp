#include <algorithm>
#include <utility>

#include "boards/drive_direct.hpp"
#include "boards/drive_rig.hpp"
#include "flight/mavlink_autopilot.hpp"
#include "flight/motor_authority.hpp"
#include "mocks/fake_digital_in.hpp"
#include "mocks/fake_pwm.hpp"
#include "mocks/memory_stream.hpp"
#include "mocks/sim_autopilot.hpp"
#include "mocks/sim_pose_source.hpp"
#include "servo/pwm_brake.hpp"

namespace forager::boards {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kTelemetryBytes = 64U << 10U;

// Where the laboratory's brake servos stand for a pulse: the emulated side's own numbers (thesis sec. 6.7),
// neutral at 1180 us, left pressed at 1725, right at 1875.
double servo_place(const mocks::FakePwmChannel& channel, double pressed_us) {
  constexpr double kNeutral = 1180.0;
  const auto pulse = channel.pulse();
  if (!pulse) return 1.0;  // a spring presses a servo without pulses
  const double us = std::chrono::duration<double, std::micro>(*pulse).count();
  return std::clamp((us - kNeutral) / (pressed_us - kNeutral), 0.0, 1.0);
}

mocks::SimAutopilotConfig autopilot_config(const DriveScene& scene, std::uint64_t seed) {
  mocks::SimAutopilotConfig config;
  config.vehicle_type = 2;  // quadrotor
  config.motors = 4;
  config.step = 10ms;
  config.start = scene.start;
  config.guided_timeout = hal::from_seconds(scene.guided_timeout_s);
  config.guided_thrust = true;
  config.disarm_delay = 60s;
  config.seed = drive_seed(seed, DriveStream::autopilot);
  return config;
}

flight::MavlinkConfig bridge_config() {
  flight::MavlinkConfig config;
  config.pose_stream_interval = 20ms;
  config.origin = flight::GlobalOrigin{};
  return config;
}

class WireRig final : public DriveRig {
 public:
  WireRig(const DriveScene& scene, std::uint64_t seed)
      : draw_(draw_plant(scene, seed)),
        vehicle_(draw_.vehicle, scene.start),
        telemetry_("sim autopilot", mocks::MemoryStreamKind::datagrams, kTelemetryBytes),
        autopilot_(telemetry_.far(), autopilot_config(scene, seed)),
        pose_(autopilot_, draw_.pose, drive_seed(seed, DriveStream::pose)),
        pwm_("brake pwm", 2),
        keeper_(hal::from_seconds(scene.keeper_s)),
        button_("stop button") {
    autopilot_.put_on_wheels(&vehicle_);
  }

  hal::Result<> open(hal::Journal& journal) {
    autopilot_.attach(nullptr, &journal);
    auto motors = bay_.claim("autopilot");
    if (!motors) return hal::fail(std::move(motors).error());
    auto bridge = flight::MavlinkAutopilot::create(telemetry_.near(), journal, bridge_config(),
                                                   hal::Instant{}, std::move(*motors));
    if (!bridge) return hal::fail(std::move(bridge).error());
    bridge_ = std::move(*bridge);
    auto left = servo::PwmBrake::create(pwm_.channel(0), servo::laboratory_left());
    if (!left) return hal::fail(std::move(left).error());
    auto right = servo::PwmBrake::create(pwm_.channel(1), servo::laboratory_right());
    if (!right) return hal::fail(std::move(right).error());
    left_.emplace(std::move(*left));
    right_.emplace(std::move(*right));
    return {};
  }

  flight::DriveDevices devices(hal::Journal& journal) override {
    return {*bridge_, pose_, *left_, *right_, journal, &keeper_, &button_, nullptr};
  }
  mocks::RollingVehicle& vehicle() override { return vehicle_; }
  const mocks::BodyState& body() override { return autopilot_.state(); }

  void advance(hal::Instant now) override {
    constexpr double kLeftPressed = 1725.0;
    constexpr double kRightPressed = 1875.0;
    pwm_.tick(now);
    keeper_.tick(now);
    vehicle_.press(keeper_.demand(servo_place(pwm_.channel(0), kLeftPressed)),
                   keeper_.demand(servo_place(pwm_.channel(1), kRightPressed)));
    change_ground();
    autopilot_.update(now);
  }

  void strike(DriveFault fault, hal::Instant now) override {
    strike_vehicle(vehicle_, fault);
    if (fault == DriveFault::pose_lost) pose_.set_fault(mocks::PoseFault::lost);
    if (fault == DriveFault::pose_silent) pose_.set_fault(mocks::PoseFault::stall);
    if (fault == DriveFault::link_lost) autopilot_.faults().silence = {{}, hal::Duration::max()};
    if (fault == DriveFault::stop_button) button_.drive(true, now);
    if (fault == DriveFault::stop_link) autopilot_.relay_stop(bridge_config().sysid, bridge_config().compid);
  }

  bool push_demanded() const override {
    return autopilot_.wheel_thrust() > 0.0 && autopilot_.wheel_pitch_rad() > 0.0;
  }

 private:
  void change_ground() {
    const bool takes_off =
        autopilot_.armed() && autopilot_.target().kind == mocks::GuidedTarget::Kind::takeoff;
    const bool stands = !autopilot_.armed() && autopilot_.landed();
    if (takes_off && !flying_)
      autopilot_.put_on_wheels(nullptr);
    else if (stands && flying_)
      autopilot_.put_on_wheels(&vehicle_);
    else
      return;
    flying_ = !flying_;
  }

  DrivePlantDraw draw_;
  mocks::RollingVehicle vehicle_;
  mocks::MemoryStreamPair telemetry_;
  mocks::SimAutopilot autopilot_;
  mocks::SimPoseSource pose_;
  mocks::FakePwmGroup pwm_;
  BrakeKeeper keeper_;
  mocks::FakeDigitalIn button_;
  flight::MotorBay bay_;
  std::unique_ptr<flight::MavlinkAutopilot> bridge_;
  std::optional<servo::PwmBrake> left_;
  std::optional<servo::PwmBrake> right_;
  bool flying_ = false;
};

}  // namespace

hal::Result<std::unique_ptr<DriveRig>> make_wire_rig(const DriveScene& scene, std::uint64_t seed,
                                                     hal::Journal& journal) {
  auto rig = std::make_unique<WireRig>(scene, seed);
  FORAGER_TRY(rig->open(journal));
  return std::unique_ptr<DriveRig>(std::move(rig));
}

}  // namespace forager::boards
