#pragma once

#include <string>

#include "tools/html_report.hpp"

namespace forager::tools {

// Distinct tags over time, all and by port, with the number of tags in the world as a line where it is known.
// Empty without samples.
[[nodiscard]] std::string draw_tags_over_time(const ReportData& data);

// One row per kind of decision, one tick per decision, on the same time axis. Empty without decisions.
[[nodiscard]] std::string draw_decisions_over_time(const ReportData& data);

// New tags per port as bars. Empty without ports.
[[nodiscard]] std::string draw_ports(const ReportData& data);

// Style class of a port by its place in the data, for lines and bars: "p0".."p7".
[[nodiscard]] std::string port_class(std::size_t index);

}  // namespace forager::tools
