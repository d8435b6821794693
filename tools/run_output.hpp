#pragma once

#include <string>

#include "boards/run_summary.hpp"

namespace forager::tools {

// The closing table of a run, for a person.
[[nodiscard]] std::string summary_table(const boards::RunSummary& summary, double wall_time_s);

// The closing object of a run as one JSON line (no line break): scene, title, board, policy, seed,
// tags_present (null in a real place), tags_read, other_tags_read, coverage, reads, sim_time_s,
// flight_time_s, wall_time_s, path_m, decisions, windows, end_reason, detail, reader_losses,
// autopilot_losses, radio_may_be_on, crashes, battery, ports.
[[nodiscard]] std::string summary_json(const boards::RunSummary& summary, double wall_time_s);

}  // namespace forager::tools
