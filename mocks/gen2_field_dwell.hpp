#pragma once

#include <cstdint>

#include "hal/random.hpp"
#include "mocks/gen2_field_parameters.hpp"
#include "mocks/tag_field.hpp"

namespace forager::mocks {

// One visit of the radio to one port: carrier on at `start_s`, off at `end_s`.
struct Dwell {
  std::uint64_t id = 0;  // grows by one per dwell, from 1
  std::size_t port_index = 0;
  std::uint32_t frequency_khz = 0;
  double start_s = 0.0;
  double end_s = 0.0;
};

// The rhythm of read mode AUTONOMOUS: the radio visits its ports in turn, leaves a port that brings nothing
// new within its patience, stays while new tags answer, hops to another channel at each visit and pauses
// between on-times. An on-time of zero means that the carrier never pauses.
class DwellSchedule {
 public:
  DwellSchedule(const AirParameters& air, std::uint64_t seed) : air_(air), random_(seed) {}

  // Starts anew at now_s with the first port. The settings must have at least one port.
  void start(const RadioSettings& settings, double now_s);
  // The visit after the current one; it may begin later than that one ended.
  void advance();
  // Something new answered at now_s: stay for another patience.
  void prolong(double now_s);
  // The visit ends at now_s, earlier or later than planned: a reader leaves between two rounds.
  void leave(double now_s);
  // No visit lasts longer than to here, whatever answers: max_dwell, or the end of the on-time.
  [[nodiscard]] double latest_end_s() const { return latest_end_s_; }
  [[nodiscard]] const Dwell& dwell() const { return dwell_; }

 private:
  void begin(double start_s);

  AirParameters air_;
  hal::Random random_;
  Dwell dwell_;
  std::size_t ports_ = 1;
  std::uint64_t channel_ = 0;
  double on_s_ = 0.0;
  double off_s_ = 0.0;
  double on_until_s_ = 0.0;
  double patience_s_ = 0.0;
  double latest_end_s_ = 0.0;
};

}  // namespace forager::mocks
