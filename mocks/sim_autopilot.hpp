#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "hal/byte_stream.hpp"
#include "hal/journal.hpp"
#include "hal/time.hpp"
#include "mocks/body.hpp"
#include "mocks/rolling_vehicle.hpp"
#include "mocks/sim_autopilot_config.hpp"
#include "mocks/sim_autopilot_estimator.hpp"
#include "mocks/sim_autopilot_link.hpp"
#include "mocks/sim_autopilot_target.hpp"
#include "mocks/vehicle.hpp"

namespace forager::mocks {

// A multirotor with an ArduCopter 4.6 on it, on the far end of a telemetry line. Two faces: MAVLink bytes,
// and the true body that the world, the camera and the reader see. It says only HEARTBEAT and TIMESYNC until
// asked for more, refuses what it does not know, and flies by its own estimate, which comes from the vision
// messages it is sent.
//
// update(now) runs fixed steps up to `now`, then hears what has arrived: equal bytes at equal calls give
// equal bytes, however other calls are spaced. It allocates nothing after the first.
class SimAutopilot : public TrueBody {
 public:
  SimAutopilot(hal::ByteStream& stream, const SimAutopilotConfig& config);
  SimAutopilot(const SimAutopilot&) = delete;
  SimAutopilot& operator=(const SimAutopilot&) = delete;

  // The world it can hit and the journal it notes in (crashes, modes, arming, texts; with `wire` the bytes
  // too). Either may be null; both must outlive it.
  void attach(const World* world, hal::Journal* journal, bool wire = false);
  void update(hal::Instant now);

  // Puts the autopilot onto a vehicle that stands on wheels: attitude and thrust targets push it, its state
  // is the body's. The vehicle must outlive it; null takes it off again. Whichever takes over stands where
  // the other was.
  void put_on_wheels(RollingVehicle* wheels);
  // Passes on a ground station's command to a companion computer: disarm, that is stop.
  void relay_stop(std::uint8_t system, std::uint8_t component);
  [[nodiscard]] double wheel_thrust() const { return armed_ ? attitude_.thrust : 0.0; }
  [[nodiscard]] double wheel_pitch_rad() const { return attitude_.pitch_rad; }

  [[nodiscard]] const BodyState& state() const override {
    return wheels_ != nullptr ? wheels_->state() : vehicle_.state();
  }
  [[nodiscard]] const Vehicle& vehicle() const { return vehicle_; }
  [[nodiscard]] const SimEstimator& estimator() const { return estimator_; }
  [[nodiscard]] peer::CopterMode mode() const { return mode_; }
  [[nodiscard]] bool armed() const { return armed_; }
  [[nodiscard]] bool landed() const { return landed_; }
  [[nodiscard]] const GuidedTarget& target() const { return target_; }
  [[nodiscard]] std::string_view last_text() const { return last_text_; }
  [[nodiscard]] int servo_us(int output) const;  // 1..16; 0: never set
  [[nodiscard]] const SimAutopilotLink& link() const { return link_; }
  // Setpoints taken, and setpoints not taken for the mode, the ground or the fault.
  [[nodiscard]] std::uint64_t setpoints_taken() const { return setpoints_taken_; }
  [[nodiscard]] std::uint64_t setpoints_ignored() const { return setpoints_ignored_; }

  [[nodiscard]] SimAutopilotFaults& faults() { return faults_; }
  void set_battery_fraction(double fraction) { vehicle_.set_battery_fraction(fraction); }
  // A mode switch from outside the line; `reason` goes to the journal ("pilot"). False: refused, as the real
  // one would (a text says why).
  bool set_mode(peer::CopterMode mode, std::string_view reason = {});

 private:
  struct Stream {
    const peer::MessageKind* kind = nullptr;
    hal::Duration interval{};  // zero: off
    hal::Instant next;
  };

  // sim_autopilot.cpp: time
  void start(hal::Instant now);
  void step();
  void apply_faults();
  void send_streams();

  // sim_autopilot_flight.cpp: modes and motion
  [[nodiscard]] VehicleCommand flight_command();
  void fly_guided(VehicleCommand& command);
  void fly_takeoff(VehicleCommand& command);
  void fly_land(VehicleCommand& command);
  void brake(VehicleCommand& command);
  void fly_rtl(VehicleCommand& command);
  void steer(VehicleCommand& command);
  void aim(VehicleCommand& command, hal::Vec3 position_ned_m) const;
  void watch_ground();
  void watch_estimator();
  void shift_targets(const EstimateShift& shift);
  bool arm(bool force);
  bool disarm(bool force);
  [[nodiscard]] bool check_arming(bool report);
  [[nodiscard]] std::string_view arming_obstacle() const;
  [[nodiscard]] bool in_flight() const { return armed_ && !landed_; }

  // sim_autopilot_wheels.cpp: on wheels
  void hear_attitude(const MavlinkPayload& message);
  void roll();

  // sim_autopilot_commands.cpp: what it is told
  void hear(const MavlinkPeerFrame& frame);
  void hear_command(const MavlinkPeerFrame& frame);
  void hear_setpoint(const MavlinkPayload& message);
  void hear_vision(const VisionSample& sample);
  void hear_odometry(const MavlinkPayload& message);
  void hear_origin(const MavlinkPayload& message);
  void hear_timesync(const MavlinkPeerFrame& frame);
  void hear_parameter(const MavlinkPeerFrame& frame);
  struct Command {
    std::uint16_t id = 0;
    std::array<double, 7> param{};
    bool as_int = false;
    std::uint8_t frame = 0;
  };
  [[nodiscard]] peer::Result execute(const Command& command);
  [[nodiscard]] peer::Result execute_mode(const Command& command);
  [[nodiscard]] peer::Result execute_arm(const Command& command);
  [[nodiscard]] peer::Result execute_takeoff(const Command& command);
  [[nodiscard]] peer::Result execute_yaw(const Command& command);
  [[nodiscard]] peer::Result execute_speed(const Command& command);
  [[nodiscard]] peer::Result execute_servo(const Command& command);
  [[nodiscard]] peer::Result execute_interval(const Command& command);
  [[nodiscard]] peer::Result execute_request(const Command& command);
  [[nodiscard]] Stream* stream_of(double id);

  // sim_autopilot_telemetry.cpp: what it says
  void say(const peer::MessageKind& kind);
  void say_text(std::uint8_t severity, std::string_view text);
  void say_ack(std::uint16_t command, peer::Result result, std::uint8_t system, std::uint8_t component);
  void note(std::string_view text);
  bool fill(const peer::MessageKind& kind, MavlinkPayload& p);
  void fill_heartbeat(MavlinkPayload& p) const;
  void fill_sys_status(MavlinkPayload& p);
  void fill_battery(MavlinkPayload& p) const;
  void fill_attitude(MavlinkPayload& p) const;
  void fill_local_position(MavlinkPayload& p) const;
  void fill_global_position(MavlinkPayload& p) const;
  void fill_sim_state(MavlinkPayload& p) const;
  void fill_ekf(MavlinkPayload& p) const;
  void fill_extended(MavlinkPayload& p) const;
  [[nodiscard]] std::uint32_t boot_ms() const;

  SimAutopilotConfig config_;
  SimAutopilotFaults faults_;
  SimAutopilotLink link_;
  Vehicle vehicle_;
  SimEstimator estimator_;
  RollingVehicle* wheels_ = nullptr;
  struct AttitudeTarget {
    double pitch_rad = 0.0;  // nose down positive
    double thrust = 0.0;     // 0..1
    hal::Instant heard;
    bool fresh = false;
  };
  AttitudeTarget attitude_;
  hal::Journal* journal_ = nullptr;

  bool started_ = false;
  hal::Instant epoch_;  // first update
  hal::Instant clock_;  // end of the last step
  hal::Instant now_;    // of the last update
  std::array<Stream, 13> streams_{};

  peer::CopterMode mode_;
  bool armed_ = false;
  bool landed_ = true;
  bool failsafe_ = false;
  bool origin_known_ = false;
  std::array<std::int32_t, 3> origin_{};  // 1e-7 degrees, 1e-7 degrees, mm
  GuidedTarget target_;
  hal::Vec3 home_ned_m_;
  enum class Rtl : std::uint8_t { climb, home, land };
  Rtl rtl_ = Rtl::climb;
  hal::Instant armed_at_;
  hal::Instant idle_since_;  // armed and on the ground since
  std::optional<hal::Instant> touched_at_;
  double turn_rate_rad_s_ = 0.0;  // of CONDITION_YAW; 0: the vehicle's own limit
  double turn_left_rad_ = 0.0;    // way still to go in the asked direction

  std::array<int, 16> servo_us_{};
  std::array<char, 50> text_{};
  std::string_view last_text_;
  std::uint64_t setpoints_taken_ = 0;
  std::uint64_t setpoints_ignored_ = 0;
};

}  // namespace forager::mocks
