#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/halt.hpp"
#include "hal/journal.hpp"
#include "hal/time.hpp"
#include "servo/brake_actuator.hpp"
#include "servo/brake_command.hpp"
#include "servo/brake_watch.hpp"

namespace forager::servo {

enum class BrakeState : std::uint8_t {
  engaged,    // both locked: nobody commands, or the command ran out
  following,  // does what the newest command says
  faulted,    // one brake cannot be trusted: stops with what is left, see below
  halted,     // both locked until resume()
};
[[nodiscard]] std::string_view to_string(BrakeState state);

struct BrakePairConfig {
  BrakeWatchConfig watch;  // mismatch and slip
  BrakeHeatConfig heat;
  // Stopping with one brake: it is opened while the vehicle yaws faster than this towards its side.
  double yaw_limit_rad_s = 0.35;
  // Without a fresh yaw rate it is pressed for `blind_press` out of every `blind_period` instead.
  hal::Duration blind_press = std::chrono::milliseconds(100);
  hal::Duration blind_period = std::chrono::milliseconds(300);
  // After this long on one brake, or at standstill, it stays locked. Twice the 2 s that both brakes take.
  hal::Duration stop_time = std::chrono::seconds(4);
  double standstill_m_s = 0.02;
  // A brake that was found bad is told to lock again this often; what fails altogether, at every update.
  hal::Duration tell_again = std::chrono::milliseconds(100);
};

// What the pair reports besides its state; strings are for people.
struct BrakeStatus {
  BrakeState state = BrakeState::engaged;
  std::string reason;      // of the last transition
  bool cut_thrust = true;  // the propellers must not push now; false only while following
  BrakeFault left;         // the fault found on each side; kind none if sound
  BrakeFault right;
  double left_fraction = 1.0;  // what each actuator was last told to be
  double right_fraction = 1.0;
  BrakeHeat left_heat;
  BrakeHeat right_heat;
};

// The two brakes of the vehicle, as one thing that stops it.
//
//   state      left, right                           thrust  leaves it
//   engaged    locked, locked                        cut     a fresh command -> following
//   following  as commanded, within the slew limits  may     command expires -> engaged
//                                                            an actuator fails, mismatch or slip -> faulted
//   faulted    bad one: told to lock, again and      cut     clear_fault() -> engaged; a halt -> halted
//              again; good one: stops, below
//   halted     locked, locked                        cut     resume() -> engaged
//
// From every state halt() leads to halted. A fault found while engaged leads to faulted too, one found while
// halted after resume(). Both faulted: both are told to lock. faulted is left by a person or a supervisor
// only, never by the fault going away.
//
// Stopping with one brake must not become a spin: the vehicle pivots about the wheel that holds. So the good
// brake is locked, but opened while the yaw rate towards its side is above yaw_limit; if the bad one is stuck
// locked the vehicle yaws to that side and the good one stays locked: both hold. Without a fresh yaw rate it
// is pressed in short pulses. At standstill, or after stop_time, it stays locked.
//
// Heat never opens a brake: a locked brake that burns its servo still stops the vehicle, an open one does
// not. The estimate only warns (journal, status), with the time spent above the limit.
//
// Every transition is noted in the journal with its reason. update() allocates nothing while the state stays
// and the actuators answer.
class BrakePair final : public hal::Halt {
 public:
  // Borrows all three; locks both brakes at once. Half track is BrakeWatchConfig::half_track_m.
  BrakePair(BrakeActuator& left, BrakeActuator& right, hal::Journal& journal, const BrakePairConfig& config,
            hal::Instant now);
  ~BrakePair() override;  // halts
  BrakePair(const BrakePair&) = delete;
  BrakePair& operator=(const BrakePair&) = delete;

  // The newest command replaces the one before; takes effect at the next update(). One that is not finite is
  // taken for both locked. Ignored while faulted or halted.
  void command(const BrakeCommand& command);
  // How the vehicle moves, from pose or localisation; for slip, mismatch and the one-brake stop. Optional.
  void observe(const VehicleMotion& motion);
  // Moves both actuators. To be called often: the slew limits and the expiry are judged here.
  void update(hal::Instant now);

  [[nodiscard]] BrakeState state() const { return status_.state; }
  [[nodiscard]] const BrakeStatus& status() const { return status_; }
  [[nodiscard]] bool thrust_allowed() const { return !status_.cut_thrust; }
  // Stops with one brake, and does not stand yet: it goes by what it is told of the vehicle's motion.
  [[nodiscard]] bool stopping() const {
    return status_.state == BrakeState::faulted && !stopped_ && !(status_.left && status_.right);
  }

  void halt() noexcept override;
  // Out of halted. Needs a fresh command to move again.
  void resume(hal::Instant now);
  // Out of faulted, after somebody has looked. Errors: invalid_state (not faulted). A brake that is still bad
  // is found again at the next updates. Both actuators are told anew, whatever they were told before.
  [[nodiscard]] hal::Result<> clear_fault(hal::Instant now);

 private:
  // One brake with what is known of it; the pointers lead into status_.
  struct Side {
    BrakeActuator* actuator;
    BrakeWatch watch;
    BrakeHeatModel heat;
    BrakeFault* fault;
    BrakeHeat* told_heat;
    double* fraction;
    double wanted = 1.0;
    hal::Instant tell_again_at{};
  };
  enum class Pace : std::uint8_t { slewed, at_once };

  void enter(BrakeState state, std::string_view reason, hal::Instant now);
  void begin_fault(hal::Instant now);
  void decide(hal::Instant now);
  void decide_faulted(hal::Instant now);
  [[nodiscard]] bool standing() const;
  [[nodiscard]] bool may_press(bool left, bool motion_known, hal::Instant now) const;
  void move(Side& side, Pace pace, hal::Instant now);
  void watch(Side& side, const Side& other, hal::Instant now);
  void warm(Side& side, std::string_view name, hal::Instant now);

  BrakeStatus status_;  // before the sides, which point into it
  Side left_;
  Side right_;
  hal::Journal* journal_;
  BrakePairConfig config_;
  BrakeCommand command_;
  std::optional<VehicleMotion> motion_;
  hal::Instant now_;
  hal::Instant faulted_at_;
  bool stopped_ = false;
};

}  // namespace forager::servo
