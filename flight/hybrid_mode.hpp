#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flight/autopilot.hpp"
#include "flight/ground_driver.hpp"
#include "flight/hybrid_route.hpp"
#include "flight/localisation.hpp"
#include "flight/step_flight.hpp"
#include "hal/halt.hpp"
#include "hal/journal.hpp"
#include "hal/pose_source.hpp"

namespace forager::flight {

// Borrowed; all must outlive the mode.
struct HybridDevices {
  Autopilot& autopilot;
  GroundDriver& ground;
  hal::PoseSource& pose;
  VisionFilter& vision;  // the vehicle's one; the ground driver uses it while it drives
  hal::Journal& journal;
};

struct HybridConfig {
  HopLimits hop;  // for a hop planned on the way
  StepFlightConfig flight;
  double stands_m_s = 0.05;                                  // slower is standing
  hal::Duration stand_for = std::chrono::milliseconds(500);  // before the motors may start, and to hover
  double takeoff_off_m = 0.25;   // farther from the planned take-off it does not fly
  double landing_off_m = 0.30;   // farther from the planned landing it flies the rest first
  double climb_slack_m = 0.2;    // so near to the height is there
  double battery_reserve = 0.2;  // below it no hop is begun; unknown is not below
  hal::Duration ask_timeout = std::chrono::seconds(15);  // for mode, arming and take-off each
  hal::Duration climb_timeout = std::chrono::seconds(20);
  hal::Duration landing_timeout = std::chrono::seconds(60);
  // A bad pose in the air for so long: land. Silence counts as bad after VisionFilterConfig::stale_after, so
  // landing is asked for 0.7 s after the last pose that can be trusted.
  hal::Duration pose_allowance = std::chrono::milliseconds(400);
};

enum class HybridPhase : std::uint8_t {
  rolling,
  standing,
  guided,
  arming,
  climbing,
  flying,
  landing,
  stopped,  // landing or stopping because something went wrong
  done,
};
[[nodiscard]] std::string_view to_string(HybridPhase phase);

enum class HybridEnd : std::uint8_t {
  none,
  arrived,
  ground_failed,  // the ground driver gave up
  no_way,         // blocked on the ground, and no hop over it
  off_takeoff,    // not where the hop was planned to begin
  refused,        // by the autopilot: mode, arming, take-off
  battery,        // too little for a hop
  late,           // a climb, a flight or a landing took too long
  pose_lost,      // in the air
  autopilot_lost,
  pilot,  // somebody else took the vehicle in the air
  halted,
};
[[nodiscard]] std::string_view to_string(HybridEnd end);

struct HybridStatus {
  HybridPhase phase = HybridPhase::rolling;
  hal::Instant phase_since;
  HybridEnd end = HybridEnd::none;
  std::string detail;
  std::size_t leg = 0;
  std::size_t hops = 0;  // landed
  hal::Pose pose_world;  // newest known
};

// Rolls by default and flies where it must (thesis sec. 6.6.3): the legs of a route, one after the other. In
// the air as on the ground: forward and yaw only.
//
// clang-format off
//   phase    | brakes | does each update                        | goes on when              | to
//   ---------|--------|-----------------------------------------|---------------------------|--------------------------
//   rolling  | driver | lets the ground driver drive            | arrived                   | standing, or done
//            |        |                                         | blocked, a hop can be made| standing; cannot: stopped
//   standing | locked | feeds localisation to the autopilot     | stands, is where it ought | guided (hop), rolling
//   guided   | locked | asked for GUIDED once                   | in GUIDED                 | arming; refused: stopped
//   arming   | locked | asked to arm once                       | armed                     | climbing; refused,
//            |        |                                         |                           | a pilot: stopped
//   climbing | locked | asked to take off once, then holds      | at the height             | flying; late: stopped
//   flying   | locked | turns to the landing, flies forward     | over the landing, still   | landing; late: stopped
//   landing  | locked | asked to land; asks again               | on the ground, disarmed   | standing (next leg), done
//   stopped  | locked | in the air: lands; asks again           | on the ground, disarmed   | done
//   done     | locked | nothing                                 |                           |
// clang-format on
//
// Wheels are locked whenever the ground driver does not drive, so a vehicle that touches down stays where it
// is. The way over an obstacle was planned from its known height: nothing looks at it from the air, and a
// flight of a few metres is finished rather than broken off over the obstacle - except for a lost pose, a
// halt or a flight that takes too long: then it lands where it is. A silent autopilot is left to its own
// fail-safe; a pilot who takes the vehicle keeps it. One who takes it while it is being armed gets it
// disarmed: motors that started on our request must not be a surprise.
//
// Safe state: halt() and destruction lock the brakes of a vehicle that rolls, and ask one that is under our
// command in the air to land, at once.
//
// Whoever runs it calls update() at 50 Hz or faster. Allocates only where a leg begins or ends.
class HybridMode final : public hal::Halt {
 public:
  // known: what stands on the floor, for hops planned when the ground turns out to be blocked.
  HybridMode(const HybridConfig& config, const HybridDevices& devices, HybridRoute route,
             std::vector<HopObstacle> known, hal::Instant now);

  void update(hal::Instant now);
  ~HybridMode() override;  // halts
  HybridMode(const HybridMode&) = delete;
  HybridMode& operator=(const HybridMode&) = delete;

  // Stops or asks to land at once; ends at the next updates.
  void halt() noexcept override;

  [[nodiscard]] bool done() const { return status_.phase == HybridPhase::done; }
  [[nodiscard]] const HybridStatus& status() const { return status_; }
  [[nodiscard]] const HybridRoute& route() const { return route_; }

 private:
  void roll(hal::Instant now);
  void stand(hal::Instant now);
  void wait_for_mode(hal::Instant now);
  void wait_for_arming(hal::Instant now);
  void climb(hal::Instant now);
  void fly(hal::Instant now);
  void land(hal::Instant now);
  void come_down(hal::Instant now);
  // While it comes down: true when a pilot took it. Asks again what was lost.
  [[nodiscard]] bool taken_while_landing();
  void ask_down(hal::Instant now);

  void begin_leg(hal::Instant now);
  void begin_roll(hal::Instant now);
  void begin_hop(hal::Instant now);
  void leg_over(hal::Instant now);
  void hop_instead(std::string_view blocked, hal::Instant now);
  void aim(hal::Instant now);
  [[nodiscard]] bool gone_wrong_in_the_air(hal::Instant now);
  [[nodiscard]] bool refused(std::string_view what, hal::Instant now);
  [[nodiscard]] bool waited(hal::Duration allowed, hal::Instant now) const;
  void stop(HybridEnd why, std::string_view detail, hal::Instant now);
  void give_up_arming(hal::Instant now);
  void give_up_command(HybridEnd why, std::string_view detail, hal::Instant now);
  void set_end(HybridEnd why, std::string_view detail, hal::Instant now);
  void enter(HybridPhase phase, hal::Instant now);
  [[nodiscard]] const Hop& hop() const { return route_.legs[status_.leg].hop; }

  HybridConfig config_;
  Autopilot* autopilot_;
  GroundDriver* ground_;
  hal::Journal* journal_;
  HybridRoute route_;
  std::vector<HopObstacle> known_;
  Localisation localisation_;
  StepFlight flight_;
  HybridStatus status_;
  double floor_z_m_ = 0.0;  // of the pose's origin, where it took off
  std::optional<hal::Instant> still_since_;
  hal::Instant ask_again_at_;
  std::optional<std::uint32_t> landing_mode_;  // the autopilot's, once it lands
  bool halt_asked_ = false;
};

}  // namespace forager::flight
