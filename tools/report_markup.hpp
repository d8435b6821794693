#pragma once

#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "flight/mission.hpp"
#include "hal/time.hpp"

namespace forager::tools {

// Text made safe in XML text and attributes: the five special characters escaped, control characters and
// bytes that are not UTF-8 replaced by U+FFFD.
[[nodiscard]] std::string escape_markup(std::string_view text);

// A coordinate in drawing units: one decimal, no trailing zero, so that the page stays small.
[[nodiscard]] std::string units(double value);

// Values a person would put on an axis (1, 2, 5 times a power of ten apart), within [low, high], at most
// `most` + 1 of them. Empty for an empty or non-finite range.
[[nodiscard]] std::vector<double> axis_ticks(double low, double high, int most);

// "0.5", "20": as few decimals as tell the ticks apart.
[[nodiscard]] std::string tick_label(double value, const std::vector<double>& ticks);

// "F: forward"
[[nodiscard]] std::string_view meaning(flight::DecisionKind kind);
// Class name for the style sheet: "f", "tl".
[[nodiscard]] std::string_view style_class(flight::DecisionKind kind);
inline constexpr flight::DecisionKind kDecisionKinds[] = {
    flight::DecisionKind::forward,   flight::DecisionKind::turn_left, flight::DecisionKind::turn_right,
    flight::DecisionKind::turn_back, flight::DecisionKind::stay,      flight::DecisionKind::land};

// "at 12.4 s: forward 1.0 m towards 45 degrees, 5 new tags", for tooltips.
[[nodiscard]] std::string describe_decision(const flight::Decision& decision, hal::Instant started);

// Appends formatted text.
template <class... Arguments>
void put(std::string& out, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  fmt::format_to(std::back_inserter(out), format, std::forward<Arguments>(arguments)...);
}

}  // namespace forager::tools
