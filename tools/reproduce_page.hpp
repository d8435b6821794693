#pragma once

#include <string>

#include "boards/reproduce.hpp"

namespace forager::tools {

// One self-contained page: published and simulated coverage side by side, the table of both with their
// differences, and tags against time for every experiment flown. No script, nothing loaded from elsewhere;
// the same result gives the same bytes.
[[nodiscard]] std::string reproduction_page(const boards::Reproduction& result);

}  // namespace forager::tools
