#pragma once

#include <vector>

#include "hal/error.hpp"
#include "tools/bench_row.hpp"

namespace forager::tools {

struct JitterCommand {
  double seconds = 5.0;  // of each of the four cases
  bool json = false;
};

// Rows of software PWM at 50 and 333 Hz, idle and with every processor busy: how far pulses and periods are
// from what they should be.
[[nodiscard]] hal::Result<std::vector<BenchRow>> bench_jitter(double seconds);

// Prints them, and on stderr whether the thread had real-time priority. Gives an exit code of
// tools/cli_style.hpp.
int run_bench_jitter(const JitterCommand& command);

}  // namespace forager::tools
