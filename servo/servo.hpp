#pragma once

#include <cstdint>
#include <optional>

#include "hal/error.hpp"
#include "hal/halt.hpp"
#include "hal/pwm.hpp"
#include "hal/time.hpp"
#include "servo/pulse_map.hpp"

namespace forager::servo {

// What halt() leaves behind.
enum class AtHalt : std::uint8_t {
  hold,     // pulses of the safe place go on: the servo is held there by its motor
  release,  // pulses end once it had time to get there: what it does then depends on its make (stays, or goes
            // limp)
};

// Units of `at` are those of the map: a fraction, or radians.
struct ServoConfig {
  double safe = 0.0;        // where it is taken to be at first, and where halt() sends it
  double slew_per_s = 4.0;  // units of the map per second; positive, infinity: no limit
  hal::Duration trim{};     // added to every pulse, before the end stops
  hal::Duration min_pulse = std::chrono::microseconds(500);  // end stops: no pulse ever outside
  hal::Duration max_pulse = std::chrono::microseconds(2500);
  AtHalt at_halt = AtHalt::hold;
  // A pause between two calls counts as this much at most: a servo that has stood still for a minute still
  // starts no faster than its slew limit.
  hal::Duration longest_step = std::chrono::milliseconds(100);
  // A pulse that stays is sent again this often: an output that lost it learns it anew, and one that refuses
  // by now is noticed.
  hal::Duration refresh = std::chrono::milliseconds(500);
  hal::Duration release_after = std::chrono::milliseconds(300);  // with AtHalt::release: from halt() on
};

// One servo on one PWM channel. Its first command is slewed like every other, from the safe place; a servo
// that really is elsewhere at power-up jumps to the first pulse by itself, which no controller can prevent.
//
// Safe state: construction sends nothing; halt() sends the safe pulse at once, without slew, and holds. With
// AtHalt::release the calls of move() to the safe place that follow end the pulses after `release_after`, and
// nothing is sent any more until it is to be somewhere else; without such a call the pulses go on.
class Servo final : public hal::Halt {
 public:
  // Borrows the channel. Errors: invalid_argument (slew not positive, safe place not finite or outside the
  // map, stops crossed, a trim that leaves no travel, an interval that is not positive).
  [[nodiscard]] static hal::Result<Servo> create(hal::PwmChannel& channel, PulseMap map,
                                                 const ServoConfig& config);

  // Moves towards `target` as far as the slew limit allows since the last call, and tells the channel if the
  // pulse is another one or was not told for `refresh`. Errors: invalid_argument (NaN: the servo stays where
  // it is), and those of PwmChannel::set_pulse(): then the place is unchanged and the next call tries again.
  [[nodiscard]] hal::Result<> move(double target, hal::Instant now);

  // The same without slew: for stopping.
  [[nodiscard]] hal::Result<> jump(double target, hal::Instant now);

  // Whatever was sent may be lost: the next call sends its pulse.
  void forget() { sent_.reset(); }

  // Where the newest pulse leads, in units of the map, before trim.
  [[nodiscard]] double place() const { return place_; }
  // The newest pulse, trim and stops included; nothing before the first and after a release.
  [[nodiscard]] std::optional<hal::Duration> pulse() const { return sent_; }
  [[nodiscard]] const hal::PwmChannel& channel() const { return *channel_; }

  void halt() noexcept override;

 private:
  Servo(hal::PwmChannel& channel, PulseMap map, const ServoConfig& config)
      : channel_(&channel), map_(std::move(map)), config_(config), place_(config.safe) {}
  [[nodiscard]] hal::Result<> send(double place);
  [[nodiscard]] hal::Result<> send(double place, hal::Instant now);
  [[nodiscard]] hal::Result<bool> released(double wanted, hal::Instant now);

  hal::PwmChannel* channel_;
  PulseMap map_;
  ServoConfig config_;
  double place_;
  std::optional<hal::Duration> sent_;
  std::optional<hal::Instant> last_;
  std::optional<hal::Instant> sent_at_;
  bool halted_ = false;                    // since, only the safe place was asked for
  std::optional<hal::Instant> halted_at_;  // the first move() since
  bool released_ = false;
};

}  // namespace forager::servo
