#pragma once

#include <string_view>

namespace forager::tools {

// The report's style sheet: light and dark by the reader's preference, one column on a phone, two on a desk,
// ink-saving on paper. Holds neither '<' nor '&', so that it needs no escaping.
[[nodiscard]] std::string_view report_style();

}  // namespace forager::tools
