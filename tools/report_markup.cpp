#include "tools/report_markup.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "hal/units.hpp"

namespace forager::tools {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

// Length of the well-formed UTF-8 sequence at the start of text, 0 if there is none (RFC 3629 section 4).
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  // Overlong forms, surrogates and what lies beyond U+10FFFF.
  if ((lead == 0xE0 && byte(1) < 0xA0) || (lead == 0xED && byte(1) > 0x9F) ||
      (lead == 0xF0 && byte(1) < 0x90) || (lead == 0xF4 && byte(1) > 0x8F))
    return 0;
  // U+FFFE and U+FFFF are no characters in XML.
  if (lead == 0xEF && byte(1) == 0xBF && byte(2) >= 0xBE) return 0;
  return length;
}

}  // namespace

std::string escape_markup(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const char c = text.front();
    if (length == 0 || (static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n') || c == 0x7F)
      out += kReplacement;
    else if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (c == '\'')
      out += "&#39;";
    else
      out += text.substr(0, length);
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

std::string units(double value) {
  const double rounded = std::round(value * 10.0) / 10.0;
  return fmt::format("{}", rounded == 0.0 ? 0.0 : rounded);  // no "-0"
}

std::vector<double> axis_ticks(double low, double high, int most) {
  std::vector<double> ticks;
  if (!std::isfinite(low) || !std::isfinite(high) || high <= low || most < 1) return ticks;
  const double rough = (high - low) / most;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double factor : {5.0, 2.0, 1.0})
    if (factor * power >= rough * (1.0 - 1e-9)) step = factor * power;
  for (double i = std::ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i)
    ticks.push_back(i * step);
  return ticks;
}

std::string tick_label(double value, const std::vector<double>& ticks) {
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0;
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
  const double shown = std::abs(value) < step * 1e-6 ? 0.0 : value;
  return fmt::format("{:.{}f}", shown, decimals);
}

std::string_view meaning(flight::DecisionKind kind) {
  switch (kind) {
    case flight::DecisionKind::forward:
      return "forward";
    case flight::DecisionKind::turn_left:
      return "turn left";
    case flight::DecisionKind::turn_right:
      return "turn right";
    case flight::DecisionKind::turn_back:
      return "turn back";
    case flight::DecisionKind::stay:
      return "stay and listen";
    case flight::DecisionKind::land:
      return "land";
  }
  return "unknown";
}

std::string_view style_class(flight::DecisionKind kind) {
  switch (kind) {
    case flight::DecisionKind::forward:
      return "f";
    case flight::DecisionKind::turn_left:
      return "tl";
    case flight::DecisionKind::turn_right:
      return "tr";
    case flight::DecisionKind::turn_back:
      return "tb";
    case flight::DecisionKind::stay:
      return "s";
    case flight::DecisionKind::land:
      return "l";
  }
  return "s";
}

std::string describe_decision(const flight::Decision& decision, hal::Instant started) {
  return fmt::format("{:.1f} s: {}, {:.1f} m towards {:.0f}°, {} new {}",
                     hal::to_seconds(decision.at - started), meaning(decision.kind), decision.step_m,
                     hal::rad_to_deg(decision.heading_rad), decision.new_tags,
                     decision.new_tags == 1 ? "tag" : "tags");
}

}  // namespace forager::tools
