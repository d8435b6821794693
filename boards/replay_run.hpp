#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "boards/run_summary.hpp"
#include "hal/journal.hpp"
#include "hal/recording.hpp"

namespace forager::boards {

// What a recording is of: the answer of its record "run <begin", as `forager run --record` writes it.
struct RecordedRun {
  std::string scene;   // file
  std::string policy;  // empty: the scene's
  std::string board;   // sim, or a file
  std::uint64_t seed = 1;
};
[[nodiscard]] hal::Fields fields_of(const RecordedRun& run);
// Nothing: it is the recording of something else, a bench for example.
[[nodiscard]] std::optional<RecordedRun> recorded_run(const std::vector<hal::Record>& records);

struct ReplayOutcome {
  std::uint64_t ticks = 0;               // updates of the run
  std::size_t calls = 0;                 // of the recording
  std::size_t calls_left = 0;            // not made again
  std::optional<hal::Error> difference;  // the first call that was another one
  RunSummary summary;
};

// Runs the mission once more at the times of the recording, its drivers before devices that answer from it:
// no device of the board is opened. Errors: invalid_argument (the recording is of no run), those of loading
// scene and board and of Run::prepare().
[[nodiscard]] hal::Result<ReplayOutcome> replay_run(const std::vector<hal::Record>& records,
                                                    hal::Journal& journal);

}  // namespace forager::boards
