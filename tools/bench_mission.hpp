#pragma once

#include <vector>

#include "boards/scene.hpp"
#include "hal/error.hpp"
#include "tools/bench_row.hpp"

namespace forager::tools {

// Flies a scene `repeats` times with every device emulated, as fast as it goes, on one core, from preparing
// it to its summary, and gives medians:
//   "mission 4A"                 simulated seconds a second, against real time
//   "mission 4A, <part>"         seconds a mission spends there, against the whole; the parts add up to it
// Time is taken apart in missions of their own, each after one without, as looking at the clock costs some.
// Errors: those of boards::Run.
[[nodiscard]] hal::Result<std::vector<BenchRow>> bench_mission(const boards::Scene& scene, int repeats);

}  // namespace forager::tools
