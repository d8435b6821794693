#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "flight/autopilot.hpp"
#include "flight/deadman.hpp"
#include "flight/drive_autopilot.hpp"
#include "flight/mavlink_attitude.hpp"
#include "flight/mavlink_config.hpp"
#include "flight/mavlink_link.hpp"
#include "flight/mavlink_request.hpp"
#include "flight/mavlink_servos.hpp"
#include "flight/mavlink_setpoint.hpp"
#include "flight/mavlink_streams.hpp"
#include "flight/mavlink_telemetry.hpp"
#include "flight/motor_authority.hpp"
#include "hal/byte_stream.hpp"
#include "hal/journal.hpp"

namespace forager::flight {

// An ArduCopter 4.6 (GUIDED) at the other end of a byte stream. Everything happens in update(): it opens and
// reopens the stream, listens, asks for the messages it needs, repeats commands until they are answered, and
// sends heartbeats and the setpoint in force. Only send_vision() and halt() send at once.
//
// Silent before the first feed_deadman(), but for requests. When the deadman expires, heartbeats stop and the
// setpoint is dropped; a request under way is still brought to its end, as it may be the one to land.
//
// halt() stops the motors of a vehicle that we drive by attitude, as it stands on its wheels: GUIDED and
// heard of, not told to take off since, and no higher than where that began. Otherwise it asks to land, and
// only while the vehicle is under our command (GUIDED): a pilot who took it keeps it.
//
// Steady-state updates allocate nothing; a changing link, a new autopilot and refusals do.
class MavlinkAutopilot final : public DriveAutopilot {
 public:
  // Borrows stream and journal; owns the motors until it is destroyed. Errors: invalid_argument (an interval
  // or time-out that is not positive), invalid_state (an authority that was moved from), unsupported (a
  // signing key, but built without libcrypto), io.
  [[nodiscard]] static hal::Result<std::unique_ptr<MavlinkAutopilot>> create(hal::ByteStream& stream,
                                                                             hal::Journal& journal,
                                                                             const MavlinkConfig& config,
                                                                             hal::Instant now,
                                                                             MotorAuthority motors);

  void update(hal::Instant now) override;
  [[nodiscard]] const AutopilotState& state() const override { return telemetry_.state(); }
  void feed_deadman(hal::Instant now) override { deadman_.feed(now); }

  void request_guided(hal::Instant now) override;
  void request_arm(hal::Instant now) override;
  void request_takeoff(double height_m, hal::Instant now) override;
  void request_land(hal::Instant now) override;
  void request_disarm(hal::Instant now) override;
  void cancel_request() override {
    request_.cancel();
    noted_ = RequestState::none;
  }
  [[nodiscard]] RequestState request_state() const override { return request_.state(); }
  [[nodiscard]] const std::string& request_detail() const override { return request_.detail(); }

  void set_position(const PositionSetpoint& setpoint) override;
  void set_velocity(const VelocitySetpoint& setpoint) override;
  void clear_setpoint() override {
    setpoint_.clear();
    attitude_.clear();
  }

  void set_attitude(const AttitudeSetpoint& setpoint) override;
  [[nodiscard]] std::optional<double> take_yaw_rate() override;
  [[nodiscard]] hal::Instant attitude_heard() const override {
    return telemetry_.attitude_at().value_or(hal::Instant::min());
  }
  [[nodiscard]] bool stop_heard() const override { return stop_heard_; }
  void request_stop_motors(hal::Instant now) override;
  void send(hal::Instant now) override;

  // Not sent: what comes sooner than the vision interval after the one before, and what is not finite.
  void send_vision(const hal::PoseSample& sample) override;
  void halt() noexcept override;

  // Outputs the autopilot leaves to us. Commands go out in update(), while the link is up.
  [[nodiscard]] MavlinkServos& servos() { return servos_; }
  [[nodiscard]] const MavlinkLink& link() const { return link_; }
  [[nodiscard]] Deadman::State deadman_state() const { return deadman_.state(); }

 private:
  MavlinkAutopilot(hal::ByteStream& stream, hal::Journal& journal, const MavlinkConfig& config,
                   std::optional<mavlink::Signing> signing, hal::Instant now, MotorAuthority motors);

  void hear(const mavlink::Frame& frame, hal::Instant now);
  void hear_command(const mavlink::Frame& frame, hal::Instant now);
  void answer_timesync(const mavlink::Frame& frame, hal::Instant now);
  [[nodiscard]] bool is_for_us(std::uint8_t sysid, std::uint8_t compid) const;
  void send_command(mavlink::CommandLong command, hal::Instant now);
  void send_heartbeat(hal::Instant now);
  void send_requests(hal::Instant now);
  void send_streams_and_origin(hal::Instant now);
  void send_setpoint(hal::Instant now);
  void send_attitude(hal::Instant now);
  void stop_motors_at_once();
  [[nodiscard]] bool on_its_wheels() const;
  void begin(std::string_view what, const mavlink::CommandLong& command, hal::Instant now);
  void begin_mode(std::string_view what, std::uint32_t mode, hal::Instant now);
  void note_outcome(hal::Instant now);

  MotorAuthority motors_;
  hal::Journal* journal_;
  MavlinkConfig config_;
  MavlinkLink link_;
  MavlinkTelemetry telemetry_;
  MavlinkRequest request_;
  MavlinkStreams streams_;
  MavlinkSetpoint setpoint_;
  MavlinkAttitude attitude_;
  MavlinkServos servos_;
  std::optional<double> rolls_at_z_m_;  // driven by attitude since it was there; cleared by what flies it
  bool stop_heard_ = false;
  std::optional<hal::Instant> yaw_rate_taken_;
  Deadman deadman_;
  hal::Instant now_;  // of the newest update
  std::optional<hal::Instant> next_heartbeat_;
  std::optional<hal::Instant> next_origin_;
  int origin_tries_ = 0;
  bool origin_known_ = false;
  std::optional<hal::Instant> last_vision_;
  RequestState noted_ = RequestState::none;
};

}  // namespace forager::flight
