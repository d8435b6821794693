#pragma once

#include <cstdint>
#include <vector>

#include "mocks/gen2_field_parameters.hpp"

namespace forager::mocks {

// The inventoried flags of all tags in the four sessions of Gen2 (table 6.14): A at first, turned by each
// singulation, back to A when their persistence ends. Times in seconds on one line that only goes forward.
//   S0      lost at once with the carrier: it lasts for one dwell
//   S1      a timer from the singulation on, powered or not
//   S2, S3  for ever while powered, then a timer
// Timers are fixed for each tag.
class SessionFlags {
 public:
  SessionFlags(std::size_t tags, const AirParameters& air, std::uint64_t seed);

  // Would this tag answer a query now? target: 'A', 'B', '*' (both in turn).
  [[nodiscard]] bool answers(std::uint32_t tag, int session, char target, double now_s,
                             std::uint64_t dwell) const;
  // The tag was singulated: its flag turns. With target '*' it is silent until quiet_until_s, the end of the
  // round.
  void singulate(std::uint32_t tag, int session, char target, double now_s, std::uint64_t dwell,
                 double quiet_until_s);

  // True from the first singulation in S2 or S3 on: from then on somebody must say which tags have power.
  [[nodiscard]] bool needs_power_watch() const { return needs_power_watch_; }
  // Tags with a flag that power keeps.
  [[nodiscard]] bool holds(std::uint32_t tag) const { return held_[0][tag] != 0 || held_[1][tag] != 0; }
  void set_power(std::uint32_t tag, bool powered, double now_s);

 private:
  [[nodiscard]] bool is_b(std::uint32_t tag, int session, double now_s, std::uint64_t dwell) const;

  std::vector<std::uint64_t> s0_dwell_;  // dwell in which the flag was set; 0: none
  std::vector<double> s1_until_;
  std::vector<std::uint8_t> held_[2];  // S2 and S3
  std::vector<std::uint8_t> powered_;
  std::vector<double> power_lost_;
  std::vector<double> quiet_until_;
  std::vector<double> s1_persistence_;
  std::vector<double> s2_persistence_;
  bool needs_power_watch_ = false;
};

}  // namespace forager::mocks
