#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flight/deadman.hpp"
#include "flight/drive_autopilot.hpp"
#include "flight/drive_corridor.hpp"
#include "flight/interlocks.hpp"
#include "flight/obstacle_guard.hpp"
#include "flight/vision_filter.hpp"
#include "hal/depth_source.hpp"
#include "hal/digital_in.hpp"
#include "hal/digital_out.hpp"
#include "hal/halt.hpp"
#include "hal/journal.hpp"
#include "hal/pose_source.hpp"
#include "servo/brake_actuator.hpp"
#include "servo/brake_steer.hpp"
#include "servo/brakes.hpp"

namespace forager::flight {

// What driving needs. Borrowed; all must outlive the loop.
struct DriveDevices {
  DriveAutopilot& autopilot;
  hal::PoseSource& pose;
  servo::BrakeActuator& left_brake;
  servo::BrakeActuator& right_brake;
  hal::Journal& journal;
  // Changes its level at every update: whoever keeps the brakes when this program is gone (a watchdog relay,
  // a servo board of its own) locks them when it stops. Without one, a crash leaves the brakes as they were.
  hal::DigitalOut* alive = nullptr;
  hal::DigitalIn* stop_button = nullptr;  // active: pressed, or its wire is broken (board file's polarity)
  hal::DepthSource* depth = nullptr;      // with it, the way ahead is watched
  // The vehicle's, where others read its localisation before and after: a new filter would take the way in
  // between for a jump, and count resets from 0. Without one the loop has its own.
  VisionFilter* vision = nullptr;
};

struct DriveConfig {
  // A wheel's speed is known to about 0.1 m/s while the vehicle swings about it, and a touch of a brake may
  // make a slow wheel stand for a moment.
  DriveConfig() {
    brakes.watch.slip_m_s = 0.2;
    brakes.watch.turning_m_s = 0.25;
    brakes.watch.confirm = std::chrono::milliseconds(200);
  }
  servo::BrakeSteerConfig steer;
  servo::BrakePairConfig brakes;
  VisionFilterConfig vision;
  GuardConfig guard;
  hal::Duration deadman = std::chrono::milliseconds(300);           // between two feed()
  hal::Duration attitude_timeout = std::chrono::milliseconds(250);  // ATTITUDE not heard: link lost
  hal::Duration start_timeout = std::chrono::seconds(30);
  hal::Duration blocked_for = std::chrono::seconds(30);  // something in the way for so long ends the mission
  hal::Duration stopping_for = std::chrono::seconds(4);  // until it has to be disarmed; longer on one brake
  hal::Duration command_life = std::chrono::milliseconds(150);  // of attitude and brake commands
  double corridor_margin_m = 0.05;  // stops this much before the corridor's border
};

// Where to drive. World frame.
struct DriveMission {
  std::vector<servo::SteerStep> steps;
  std::optional<double> goal_heading_rad;
  DriveCorridor corridor;
};

enum class DrivePhase : std::uint8_t { waiting, guided, arming, driving, stopping, done };
[[nodiscard]] std::string_view to_string(DrivePhase phase);

enum class DriveEnd : std::uint8_t {
  none,
  arrived,         // within both margins of the goal
  missed,          // the controller could not bring it there
  emergency_stop,  // button or link
  deadman,         // whoever watches over the loop went away
  autopilot_lost,
  pilot,  // somebody else took the vehicle or disarmed it
  pose_lost,
  brake_fault,
  left_corridor,
  no_motion,  // motors dead, or brakes that do not hold
  blocked,    // something in the way did not go away
  refused,    // the autopilot refused mode or arming, or something was missing at the start
  halted,     // asked to stop
};
[[nodiscard]] std::string_view to_string(DriveEnd end);

struct DriveStatus {
  DrivePhase phase = DrivePhase::waiting;
  hal::Instant phase_since;
  DriveEnd end = DriveEnd::none;
  std::string detail;
  std::optional<hal::Instant> drove_from;    // armed and allowed to push
  std::optional<hal::Instant> stopped_from;  // when it decided to end: thrust cut and brakes told to lock
  hal::Pose pose_world;                      // estimate
  double speed_m_s = 0.0;
  double yaw_rate_rad_s = 0.0;
  double corridor_m = 0.0;  // distance from its path
  bool thrust_allowed = false;
};

// A drive from links to disarming: pose -> steps -> brakes and thrust. Call update() at 50 Hz or faster; it
// drives autopilot and brakes, and never blocks.
//
//   waiting -> guided -> arming -> driving -> stopping -> done
//
// Whoever runs it calls feed() (the dead-man) and go() (the mission's own command, with an end) again and
// again. Both brakes are locked and thrust is zero in every phase but driving, and there whenever a row of
// kInterlockTable does not hold. A row that latches ends the mission in stopping: thrust zero, brakes locked,
// motors stopped through the autopilot unless a pilot has it or takes it meanwhile. What decides goes out in
// the same update. Every command that goes out says until when it holds; nothing here needs a later call to
// become safe.
//
// update() allocates nothing while driving, but what the journal does.
class DriveLoop final : public hal::Halt {
 public:
  DriveLoop(const DriveConfig& config, const DriveDevices& devices, DriveMission mission, hal::Instant now);

  void update(hal::Instant now);
  // Somebody watches.
  void feed(hal::Instant now) { deadman_.feed(now); }
  // The mission wants it to move, until then.
  void go(hal::Instant valid_until) { go_until_ = valid_until; }

  // Brakes locked and motors told to stop at once, unless a pilot has the vehicle; ends at the next update().
  void halt() noexcept override;

  [[nodiscard]] bool done() const { return status_.phase == DrivePhase::done; }
  [[nodiscard]] const DriveStatus& status() const { return status_; }
  [[nodiscard]] const servo::BrakeSteer& steer() const { return steer_; }
  [[nodiscard]] const servo::BrakePair& brakes() const { return brakes_; }
  [[nodiscard]] const Interlocks& interlocks() const { return interlocks_; }
  [[nodiscard]] const DriveMission& mission() const { return mission_; }

 private:
  void sense(hal::Instant now);
  void look(hal::Instant now);
  void judge(hal::Instant now);
  void note_steering(hal::Instant now);
  void run_phase(hal::Instant now);
  void act(hal::Instant now);
  void wait_for_links(hal::Instant now);
  void wait_for_mode(hal::Instant now);
  void wait_for_arming(hal::Instant now);
  void drive(hal::Instant now);
  void stop(DriveEnd why, std::string_view detail, hal::Instant now);
  void stopping(hal::Instant now);
  [[nodiscard]] bool refused(std::string_view what, hal::Instant now);
  [[nodiscard]] bool at_goal() const;
  void hand_over();
  void note_first(bool& failed, const hal::Error* error, hal::Instant now);
  [[nodiscard]] bool waited(hal::Duration allowed, hal::Instant now) const;
  void enter(DrivePhase phase, hal::Instant now);

  DriveConfig config_;
  DriveAutopilot* autopilot_;
  hal::PoseSource* pose_;
  hal::Journal* journal_;
  hal::DigitalOut* alive_;
  hal::DigitalIn* stop_button_;
  hal::DepthSource* depth_;
  DriveMission mission_;
  servo::BrakePair brakes_;
  servo::BrakeSteer steer_;
  VisionFilter own_filter_;
  VisionFilter* filter_;
  ObstacleGuard guard_;
  Interlocks interlocks_;
  Deadman deadman_;
  DriveStatus status_;
  servo::SteerInput input_;
  servo::SteerOutput output_;
  hal::Instant go_until_{hal::Duration::min()};
  hal::Instant last_pose_{hal::Duration::min()};  // stamp of the newest given to the controller
  servo::SteerPhase noted_ = servo::SteerPhase::idle;
  bool alive_level_ = false;
  bool button_failed_ = false;
  bool button_pressed_ = false;
  bool halt_asked_ = false;
  bool landing_asked_ = false;  // by halt(): it may leave GUIDED for that
  bool alive_failed_ = false;
  bool pose_failed_ = false;
  bool depth_failed_ = false;
  bool was_armed_ = false;
  bool blocked_ = false;  // something stands in the way
  hal::Instant ask_again_at_;
  hal::Instant measured_from_;  // poses have come without a gap since
};

}  // namespace forager::flight
