#pragma once

#include <cstdint>
#include <string>

#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::boards {

// A brake's servo on software PWM, on a machine that has nothing else to do or too much.
struct JitterCase {
  double frequency_hz = 50.0;
  bool loaded = false;  // with as many busy threads as there are processors, at normal priority
  hal::Duration time = std::chrono::seconds(5);
};

// Distribution of an error in time.
struct Lateness {
  hal::Duration median, most_of_99, worst;
};

struct JitterFigures {
  Lateness pulse;   // of its length, 1500 us
  Lateness period;  // of the distance between two rising edges
  std::uint64_t pulses = 0;
  std::uint64_t missed_periods = 0;
  std::string facts;  // "SCHED_FIFO 50, memory locked", or why not
};

// Makes pulses for so long, on a line that only takes the time of its edges: what an oscilloscope would see
// on a line that switches at once. Errors: those of hal::open_software_pwm().
[[nodiscard]] hal::Result<JitterFigures> measure_jitter(const JitterCase& test);

}  // namespace forager::boards
