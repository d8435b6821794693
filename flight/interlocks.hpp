#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "hal/journal.hpp"
#include "hal/time.hpp"

namespace forager::flight {

// What must be true before motors may run or push.
enum class Interlock : std::uint8_t {
  emergency_stop,  // no stop button pressed, none told over MAVLink
  deadman,         // whoever watches over the loop says so again and again
  autopilot_link,  // heartbeats and attitude are fresh
  control,         // the autopilot takes our commands; no pilot has taken the vehicle
  pose,            // localisation is fresh and trusts itself
  brakes,          // both brakes do what they are told
  corridor,        // the vehicle is on its way, not beside it
  motion,          // it moves as it is pushed, and stands when it is braked
  command,         // the mission's command has not run out
  way_ahead,       // nothing stands in the way
};
inline constexpr std::size_t kInterlockCount = 10;
[[nodiscard]] std::string_view to_string(Interlock interlock);

// One row of the table. In every row that does not hold thrust is cut and both brakes lock, at once.
struct InterlockRule {
  Interlock interlock;
  bool to_arm;     // must hold to arm
  bool to_thrust;  // must hold to push
  bool latches;    // once lost, it is lost until reset(): a person or the next mission
  bool disarms;    // motors are disarmed too, not only held at zero
  std::string_view why;
};

// The safety core's whole table: who may arm, who may thrust, what must be true. There is one who may do
// either: the drive loop, and only through Interlocks.
inline constexpr std::array<InterlockRule, kInterlockCount> kInterlockTable{{
    {Interlock::emergency_stop, true, true, true, true, "emergency stop"},
    {Interlock::deadman, true, true, true, true, "nobody watches over the loop"},
    {Interlock::autopilot_link, true, true, true, true, "the autopilot is not heard"},
    {Interlock::control, false, true, true, false, "somebody else has the vehicle"},
    {Interlock::pose, true, true, false, false, "no trustworthy pose"},
    {Interlock::brakes, true, true, true, true, "a brake cannot be trusted"},
    {Interlock::corridor, true, true, true, true, "outside its corridor"},
    {Interlock::motion, true, true, true, true, "it does not move as it is told"},
    {Interlock::command, false, true, false, false, "the mission's command ran out"},
    {Interlock::way_ahead, false, true, false, false, "something stands in the way"},
}};

// Decides from the table. Everything is lost until it was first said to hold. Each change is noted in the
// journal with its reason, in the order of the table. Allocates nothing but what the journal does.
class Interlocks {
 public:
  explicit Interlocks(hal::Journal& journal) : journal_(&journal) {}

  // Says how one row stands; `detail` (for people) is noted when it is lost.
  void say(Interlock interlock, bool holds, std::string_view detail = {});
  // Judges what was said. To be called once an update, after say().
  void update(hal::Instant now);
  // Lets go of what latched; rows that do not hold then latch again at the next update().
  void reset(hal::Instant now);

  [[nodiscard]] bool may_arm() const { return may_arm_; }
  [[nodiscard]] bool may_thrust() const { return may_thrust_; }
  // A row that latches was lost: the mission is over.
  [[nodiscard]] bool tripped() const { return tripped_; }
  [[nodiscard]] bool must_disarm() const { return must_disarm_; }
  [[nodiscard]] bool holds(Interlock interlock) const { return rows_[index(interlock)].good(); }
  // The first row, in the order of the table, that is in the way of thrust; and since when.
  [[nodiscard]] const InterlockRule* first_lost() const { return first_lost_; }
  [[nodiscard]] hal::Instant lost_since() const { return lost_since_; }
  // The first row that latched, or null: why the mission is over.
  [[nodiscard]] const InterlockRule* first_latched() const { return first_latched_; }

 private:
  struct Row {
    bool said = false;   // by the last say()
    bool holds = false;  // as of the last update()
    bool latched = false;
    bool ever = false;  // it held once; before, losing it is not worth a note
    std::array<char, 96> detail{};
    std::size_t detail_size = 0;
    [[nodiscard]] bool good() const { return holds && !latched; }
  };
  [[nodiscard]] static constexpr std::size_t index(Interlock i) { return static_cast<std::size_t>(i); }
  void note(const InterlockRule& rule, const Row& row, std::string_view what, hal::Instant now) const;

  hal::Journal* journal_;
  std::array<Row, kInterlockCount> rows_{};
  bool may_arm_ = false;
  bool may_thrust_ = false;
  bool tripped_ = false;
  bool must_disarm_ = false;
  const InterlockRule* first_lost_ = &kInterlockTable.front();
  const InterlockRule* first_latched_ = nullptr;
  hal::Instant lost_since_{};
};

}  // namespace forager::flight
