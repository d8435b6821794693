#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flight/autopilot.hpp"
#include "flight/inventory_sink.hpp"
#include "flight/localisation.hpp"
#include "flight/mission_limits.hpp"
#include "flight/mission_status.hpp"
#include "flight/obstacle_guard.hpp"
#include "flight/policy.hpp"
#include "flight/read_intake.hpp"
#include "flight/step_flight.hpp"
#include "hal/depth_source.hpp"
#include "hal/digital_out.hpp"
#include "hal/halt.hpp"
#include "hal/journal.hpp"
#include "reader/tag_reader.hpp"

namespace forager::flight {

// What a mission needs. Borrowed; all must outlive the loop.
struct RobotDevices {
  Autopilot& autopilot;
  reader::TagReader& reader;
  hal::DepthSource& depth;
  hal::PoseSource& pose;
  reader::InventoryStore& store;
  hal::Journal& journal;
  hal::DigitalOut* lamp = nullptr;  // active while armed; optional
};

struct RobotLoopConfig {
  std::vector<reader::ReadPort> ports;  // of the read plan
  reader::ShareRule share = reader::ShareRule::first_heard;
  std::size_t expected_tags = 4096;
  double takeoff_height_m = 1.8;  // above where it stands
  // Between arriving and the window: reads made on the way reach us up to this much later.
  hal::Duration settle = std::chrono::milliseconds(200);
  GuardConfig guard;
  StepFlightConfig step;
  VisionFilterConfig vision;
  InventorySinkConfig inventory;
  MissionLimits limits;
  std::size_t expected_decisions = 4096;
};

// An inventory mission from links to landing: reads -> new-tag weights -> heading -> setpoints. Call update()
// at 10 Hz or faster; it drives autopilot and reader, and never blocks.
//
// clang-format off
//   phase      | does each update                      | goes on when          | to
//   -----------|---------------------------------------|-----------------------|--------------------------
//   waiting    | feeds vision to the autopilot         | reader open, pose     | guided;
//              |                                       | good, autopilot heard | start_timeout: done
//   guided     | asked for GUIDED once                 | the autopilot is      | arming; refused: done
//   arming     | asked to arm once                     | armed                 | takeoff; refused: done
//   takeoff    | asked to take off once                | within 0.3 m of       | stepping;
//              |                                       | the height            | refused: landing
//   stepping   | turns, looks, goes on (StepFlight)    | arrived, blocked,     | listening
//              |                                       | late                  |
//   listening  | holds place; counts new tags          | window over: decide   | stepping, or landing
//   landing    | asked to land; asks again if refused  | on the ground and     | storing
//              |                                       | disarmed              |
//   silent     | no heartbeat and no command           | autopilot heard again | landing; allowance: storing
//   storing    | the reader is off, reads are stored   | stored, or allowance  | done
//   done       | nothing                               |                       |
// clang-format on
//
// In takeoff, listening and stepping the limits are judged first (mission_limits): a lost reader, pose or
// store, a low battery, a used-up flight time or a request to stop end in landing; a pilot who takes the
// vehicle out of GUIDED has it at once (done, hands off); a silent autopilot makes the loop fall silent too.
// While the reader is away the window starts anew. What the guard does not call clear is not flown into.
//
// Allocates nothing in steady state, but what journal and store allocate.
class RobotLoop final : public hal::Halt {
 public:
  RobotLoop(RobotLoopConfig config, const RobotDevices& devices, Policy& policy);

  void update(hal::Instant now);

  // Asks to end: at the next update it lands, or stays on the ground.
  void halt() noexcept override { halt_asked_ = true; }

  // The end for a caller who cannot go on with update(): a vehicle that is ours is told at once to land, the
  // reader to stop, and nothing more is commanded; done() from now on. What the store has not taken is lost.
  void abandon() noexcept;

  [[nodiscard]] bool done() const { return status_.phase == MissionPhase::done; }
  [[nodiscard]] const MissionStatus& status() const { return status_; }
  [[nodiscard]] std::span<const FlownPath::Point> path() const { return path_.points(); }
  [[nodiscard]] std::span<const PortTally> ports() const { return intake_.ports(); }
  [[nodiscard]] const GuardVerdict& way_ahead() const { return way_; }
  // Reads that the store has not taken; 0 after a good end.
  [[nodiscard]] std::size_t unstored_reads() const { return sink_.waiting(); }

 private:
  void sense(hal::Instant now);
  void look(hal::Instant now);
  void run_phase(hal::Instant now);
  void report(hal::Instant now);
  void signal(hal::Instant now);

  void wait_for_links(hal::Instant now);
  void wait_for_mode(hal::Instant now);
  void wait_for_arming(hal::Instant now);
  void climb(hal::Instant now);
  void listen(hal::Instant now);
  void decide(hal::Instant now);
  void step(hal::Instant now);
  void land(hal::Instant now);
  void stay_silent(hal::Instant now);

  [[nodiscard]] bool refused_on_ground(std::string_view what, hal::Instant now);
  [[nodiscard]] bool obey_limits(hal::Instant now);
  [[nodiscard]] Observation observe(const ClosedWindow& window, hal::Instant now) const;
  [[nodiscard]] bool waited(hal::Duration allowed, hal::Instant now) const;
  void begin_step(const Step& step, hal::Instant now);
  void open_window(hal::Instant now);
  void enter(MissionPhase phase, hal::Instant now);
  void set_end(EndReason why, std::string_view detail, hal::Instant now);
  void end_on_ground(EndReason why, std::string_view detail, hal::Instant now);
  void start_landing(EndReason why, std::string_view detail, hal::Instant now);
  void hands_off(hal::Instant now);
  void finish(hal::Instant now);
  void store_rest(hal::Instant now);
  void follow_reset();
  void note_window(const ClosedWindow& window, hal::Instant now) const;

  RobotLoopConfig config_;
  Autopilot* autopilot_;
  reader::TagReader* reader_;
  hal::DepthSource* depth_;
  reader::InventoryStore* store_;
  hal::Journal* journal_;
  hal::DigitalOut* lamp_;
  Policy* policy_;
  Localisation localisation_;
  InventorySink sink_;
  ReadIntake intake_;
  ObstacleGuard guard_;
  StepFlight flight_;
  FlownPath path_;
  MissionStatus status_;

  hal::Pose pose_world_;  // newest accepted
  GuardVerdict way_;
  double floor_z_m_ = 0.0;  // take-off plane
  Step step_;               // the one under way, or listened after
  bool blocked_ = false;    // it was cut short by the guard
  std::optional<hal::Instant> first_window_;
  hal::Instant window_opens_;
  hal::Instant window_ends_;
  bool window_open_ = false;
  bool drop_reads_ = false;  // those made before the window opens
  std::optional<hal::Instant> reader_lost_since_;
  std::optional<std::uint32_t> landing_mode_;  // the autopilot's mode once it lands
  hal::Instant ask_again_at_;
  hal::Instant lamp_retry_at_;
  bool started_ = false;
  bool lamp_on_ = false;
  bool depth_failed_ = false;
  bool halt_asked_ = false;
};

}  // namespace forager::flight
