#pragma once

#include "boards/run.hpp"
#include "hal/error.hpp"
#include "hal/time.hpp"
#include "tools/run_watch.hpp"

namespace forager::tools {

// The outermost loop of a run, the only one that waits: updates it every tick until it is done.
//
// Whatever happens, the vehicle is asked to land and the reader to stop, and both get time for it: SIGINT,
// SIGTERM or SIGHUP halt the run (a second signal kills the program), and so does an update that throws; from
// then on nobody watches any more. If the updates go on throwing, or the landing takes beyond all its own
// time limits, the run is abandoned: land and stop are sent once more, and the reader alone gets time to
// answer.
//
// Errors: io, an update threw; the detail is its text. The run has ended all the same.
[[nodiscard]] hal::Result<> run_to_end(boards::Run& run, hal::Clock& clock, RunWatch& watch);

}  // namespace forager::tools
