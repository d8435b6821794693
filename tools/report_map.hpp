#pragma once

#include <string>

#include "tools/html_report.hpp"

namespace forager::tools {

struct ReportMap {
  std::string svg;    // empty if nothing in the data has a place
  bool wide = false;  // wants the whole width of the page
};

// The floor seen from above, x to the right and y up, equal scales: shelves, tags, path, decisions.
[[nodiscard]] ReportMap draw_map(const ReportData& data);

}  // namespace forager::tools
