#pragma once

#include <cstdint>
#include <vector>

#include "mocks/gen2_field_parameters.hpp"

namespace forager::mocks {

// The inventoried flags of all tags in the four sessions of Gen2 (v1.2.0 table 6.14) and their selected flag
// SL: A and deasserted at first, back there when their persistence ends. Times in seconds on one line that
// only goes forward; a flag is gone at the very instant its timer ends.
//   S0          lost at once with the carrier: it lasts for one dwell
//   S1          a timer from the flip on, powered or not
//   S2, S3, SL  for ever while powered, then a timer
// Timers are fixed for each tag: a hash of its number, evenly within the limits given.
class SessionFlags {
 public:
  SessionFlags(std::size_t tags, const AirParameters& air, std::uint64_t seed);

  // State of a flag. dwell: number of the stretch of carrier without a break, from 1.
  [[nodiscard]] bool is_b(std::uint32_t tag, int session, double now_s, std::uint64_t dwell) const;
  // Sets it; a B starts a new timer. The tag has power.
  void set(std::uint32_t tag, int session, bool b, double now_s, std::uint64_t dwell);
  [[nodiscard]] bool selected(std::uint32_t tag, double now_s) const;
  void select(std::uint32_t tag, bool asserted);

  // Would this tag answer a query now? target: 'A', 'B', '*' (both in turn).
  [[nodiscard]] bool answers(std::uint32_t tag, int session, char target, double now_s,
                             std::uint64_t dwell) const;
  // The tag was singulated: its flag turns. With target '*' it is silent until quiet_until_s, the end of the
  // round.
  void singulate(std::uint32_t tag, int session, char target, double now_s, std::uint64_t dwell,
                 double quiet_until_s);

  // True from the first flag that power keeps on: from then on somebody must say which tags have power.
  [[nodiscard]] bool needs_power_watch() const { return needs_power_watch_; }
  // Tags with a flag that power keeps.
  [[nodiscard]] bool holds(std::uint32_t tag) const { return held_[tag] != 0; }
  void set_power(std::uint32_t tag, bool powered, double now_s);

  // Seconds from the flip to the end of an S1 flag, from the loss of power to that of S2, S3 and SL.
  [[nodiscard]] double s1_persistence_s(std::uint32_t tag) const;
  [[nodiscard]] double s2_persistence_s(std::uint32_t tag) const;

 private:
  void hold(std::uint32_t tag, std::uint8_t bit, bool asserted);
  [[nodiscard]] bool held(std::uint32_t tag, std::uint8_t bit, double now_s) const;

  std::uint64_t seed_;
  double s1_min_s_, s1_max_s_, s2_min_s_, s2_max_s_;
  std::vector<std::uint64_t> s0_dwell_;  // dwell in which the flag was set; 0: none
  std::vector<double> s1_until_;
  std::vector<std::uint8_t> held_;  // bits: S2, S3, SL
  std::vector<std::uint8_t> powered_;
  std::vector<double> power_lost_;
  std::vector<double> quiet_until_;
  bool needs_power_watch_ = false;
};

}  // namespace forager::mocks
