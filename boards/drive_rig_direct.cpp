#include "boards/drive_direct.hpp"
#include "boards/drive_rig.hpp"
#include "mocks/fake_digital_in.hpp"
#include "mocks/sim_pose_source.hpp"

namespace forager::boards {
namespace {

constexpr double kWetFriction = 0.06;  // of a slippery floor: ice-like
constexpr double kOneMotorShare = 0.75;
constexpr double kOneMotorOffset = 0.07;  // m: three of four motors pull beside the middle

class DirectRig final : public DriveRig {
 public:
  DirectRig(const DriveScene& scene, std::uint64_t seed)
      : draw_(draw_plant(scene, seed)),
        vehicle_(draw_.vehicle, scene.start),
        pose_(vehicle_, draw_.pose, drive_seed(seed, DriveStream::pose)),
        autopilot_(vehicle_, scene, draw_, drive_seed(seed, DriveStream::gyro)),
        left_("left brake"),
        right_("right brake"),
        keeper_(hal::from_seconds(scene.keeper_s)),
        button_("stop button") {}

  flight::DriveDevices devices(hal::Journal& journal) override {
    return {autopilot_, pose_, left_, right_, journal, &keeper_, &button_, nullptr};
  }
  mocks::RollingVehicle& vehicle() override { return vehicle_; }

  void advance(hal::Instant now) override {
    keeper_.tick(now);
    autopilot_.run(now);
    vehicle_.push(autopilot_.thrust(), autopilot_.pitch_rad());
    vehicle_.press(keeper_.demand(left_.demand()), keeper_.demand(right_.demand()));
    vehicle_.update(now);
  }

  void strike(DriveFault fault, hal::Instant now) override {
    strike_vehicle(vehicle_, fault);
    if (fault == DriveFault::pose_lost) pose_.set_fault(mocks::PoseFault::lost);
    if (fault == DriveFault::pose_silent) pose_.set_fault(mocks::PoseFault::stall);
    if (fault == DriveFault::link_lost) autopilot_.cut_link(true);
    if (fault == DriveFault::stop_button) button_.drive(true, now);
    if (fault == DriveFault::stop_link) autopilot_.tell_stop();
  }

  bool push_demanded() const override { return autopilot_.thrust() > 0.0 && autopilot_.pitch_rad() > 0.0; }

 private:
  DrivePlantDraw draw_;
  mocks::RollingVehicle vehicle_;
  mocks::SimPoseSource pose_;
  DirectAutopilot autopilot_;
  DirectBrake left_;
  DirectBrake right_;
  BrakeKeeper keeper_;
  mocks::FakeDigitalIn button_;
};

}  // namespace

hal::Result<std::unique_ptr<DriveRig>> make_direct_rig(const DriveScene& scene, std::uint64_t seed) {
  return std::make_unique<DirectRig>(scene, seed);
}

void strike_vehicle(mocks::RollingVehicle& vehicle, DriveFault fault) {
  using mocks::BrakeFault;
  switch (fault) {
    case DriveFault::left_stuck_here:
      return vehicle.left_brake().set_fault(BrakeFault::stuck_here);
    case DriveFault::right_stuck_here:
      return vehicle.right_brake().set_fault(BrakeFault::stuck_here);
    case DriveFault::left_stuck_locked:
      return vehicle.left_brake().set_fault(BrakeFault::stuck_locked);
    case DriveFault::right_stuck_locked:
      return vehicle.right_brake().set_fault(BrakeFault::stuck_locked);
    case DriveFault::left_open:
      return vehicle.left_brake().set_fault(BrakeFault::stuck_open);
    case DriveFault::right_open:
      return vehicle.right_brake().set_fault(BrakeFault::stuck_open);
    case DriveFault::slippery:
      return vehicle.set_friction(kWetFriction);
    case DriveFault::motors_dead:
      return vehicle.set_thrust_fault(0.0, 0.0);
    case DriveFault::one_motor_dead:
      return vehicle.set_thrust_fault(kOneMotorShare, kOneMotorOffset);
    default:
      return;
  }
}

}  // namespace forager::boards
