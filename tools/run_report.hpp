#pragma once

#include "boards/run.hpp"
#include "boards/run_summary.hpp"
#include "tools/html_report.hpp"
#include "tools/run_watch.hpp"

namespace forager::tools {

// What the report page of a finished run shows. Errors: those of the inventory.
[[nodiscard]] hal::Result<ReportData> report_of(const boards::Run& run, const boards::RunSummary& summary,
                                                const RunWatch& watch, double wall_time_s,
                                                hal::Instant ended);

}  // namespace forager::tools
