#include "tools/bench_row.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace forager::tools {
namespace {

struct Prefix {
  double factor;
  const char* symbol;
};
constexpr Prefix kPrefixes[] = {{1e9, "G"},  {1e6, "M"},       {1e3, "k"}, {1.0, ""},
                                {1e-3, "m"}, {1e-6, "\u00b5"}, {1e-9, "n"}};

// Three digits with a prefix: "12.3 M", "816 n".
std::string scaled(double value) {
  if (value == 0.0 || !std::isfinite(value)) return fmt::format("{:.3g} ", value);
  for (const Prefix& prefix : kPrefixes) {
    const double number = value / prefix.factor;
    if (std::abs(number) < 1.0 && prefix.factor > 1e-9) continue;
    const int decimals = std::abs(number) >= 99.95 ? 0 : std::abs(number) >= 9.995 ? 1 : 2;
    return fmt::format("{:.{}f} {}", number, decimals, prefix.symbol);
  }
  return {};
}

// A rate of things gets the time of one thing with it.
std::string value_text(double value, const std::string& unit) {
  std::string text = unit == "s" ? scaled(value) + unit : fmt::format("{}{}", scaled(value), unit);
  const bool counts_things = unit.ends_with("/s") && unit.find(' ') == std::string::npos;
  if (counts_things && value > 0.0) text += fmt::format(" ({}s)", scaled(1.0 / value));
  return text;
}

// Columns as a terminal shows them: bytes that continue a UTF-8 character take no room.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, width_of(text)), ' ');
}

std::string ratio_text(const BenchRow& row) {
  const auto ratio = row.ratio();
  if (!ratio) return {};
  // A part of a whole reads better in percent.
  return row.unit == "s" ? fmt::format("{:.1f} %", 100.0 * *ratio) : fmt::format("{:.3g} x", *ratio);
}

}  // namespace

std::optional<double> BenchRow::ratio() const {
  if (!peer_value) return std::nullopt;
  return ours / *peer_value;
}

std::string bench_json(const BenchRow& row) {
  using Json = nlohmann::ordered_json;
  const auto ratio = row.ratio();
  const Json j{{"name", row.name},
               {"ours", row.ours},
               {"unit", row.unit},
               {"peer", row.peer.empty() ? Json() : Json(row.peer)},
               {"peer_value", row.peer_value ? Json(*row.peer_value) : Json()},
               {"ratio", ratio ? Json(*ratio) : Json()}};
  return j.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string bench_table(std::span<const BenchRow> rows) {
  struct Line {
    std::string name, ours, ratio, peer;
  };
  std::vector<Line> lines{{"", "forager", "ratio", "against"}};
  for (const BenchRow& row : rows)
    lines.push_back(
        {row.name, value_text(row.ours, row.unit), ratio_text(row),
         row.peer_value ? fmt::format("{}: {}", row.peer, value_text(*row.peer_value, row.unit)) : row.peer});
  std::size_t name = 0;
  std::size_t ours = 0;
  for (const Line& line : lines) {
    name = std::max(name, width_of(line.name));
    ours = std::max(ours, width_of(line.ours));
  }
  std::string out;
  for (const Line& line : lines)
    out += fmt::format("{}  {}  {:>8}  {}\n", padded(line.name, name), padded(line.ours, ours), line.ratio,
                       line.peer);
  return out;
}

}  // namespace forager::tools
