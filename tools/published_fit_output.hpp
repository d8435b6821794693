#pragma once

#include <string>

#include "boards/published_fit.hpp"

namespace forager::tools {

// Parameters with intervals, then the experiments with these parameters as in reproduction_table(), _json(),
// _page().
[[nodiscard]] std::string published_fit_table(const boards::PublishedFit& fit);
[[nodiscard]] std::string published_fit_json(const boards::PublishedFit& fit);
[[nodiscard]] std::string published_fit_page(const boards::PublishedFit& fit);

}  // namespace forager::tools
