#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "boards/layout_check.hpp"

namespace forager::tools {

// In one line: "312 of 330 in place, 5 elsewhere, 13 unheard, 2 not listed".
[[nodiscard]] std::string layout_line(const boards::LayoutCheck& check);

// The counts as one object: listed, in_place, elsewhere, unplaced, unheard, strangers.
[[nodiscard]] nlohmann::ordered_json layout_json(const boards::LayoutCheck& check);

// The counts, then every tag that was heard elsewhere or is not listed.
[[nodiscard]] std::string layout_table(const boards::LayoutCheck& check);
[[nodiscard]] std::string layout_json_lines(const boards::LayoutCheck& check);

}  // namespace forager::tools
