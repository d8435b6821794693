#include "tools/accuracy_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace forager::tools {
namespace {

using boards::AccuracyRow;

bool at_most(const AccuracyRow& a, const AccuracyRow& b) {
  return a.time_ns <= b.time_ns && a.max_abs_error <= b.max_abs_error && a.failures <= b.failures;
}

bool beats(const AccuracyRow& a, const AccuracyRow& b) {
  return a.name == b.name && a.time_ns > 0.0 && at_most(a, b) && !at_most(b, a);
}

std::string time_text(double time_ns) {
  if (!(time_ns > 0.0)) return "-";
  if (time_ns < 1e3) return fmt::format("{:.3g} ns", time_ns);
  if (time_ns < 1e6) return fmt::format("{:.3g} us", time_ns / 1e3);
  if (time_ns < 1e9) return fmt::format("{:.3g} ms", time_ns / 1e6);
  return fmt::format("{:.3g} s", time_ns / 1e9);
}

// Quoted where a comma, a quote or a line break would be taken for structure.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::vector<AccuracyLine> with_pareto_fronts(std::vector<AccuracyRow> rows) {
  std::vector<AccuracyLine> lines;
  lines.reserve(rows.size());
  for (AccuracyRow& row : rows) lines.push_back({std::move(row)});
  for (AccuracyLine& line : lines)
    line.pareto = line.row.time_ns > 0.0 && std::none_of(lines.begin(), lines.end(), [&](const auto& other) {
                    return beats(other.row, line.row);
                  });
  return lines;
}

std::string accuracy_text(std::span<const AccuracyLine> lines) {
  std::string out;
  std::string name;
  std::size_t width = 0;
  for (const AccuracyLine& line : lines) width = std::max(width, line.row.variant.size());
  for (const AccuracyLine& line : lines) {
    const AccuracyRow& row = line.row;
    if (row.name != name) {
      out += fmt::format("{}{}  [against {}]\n    {:{}}  {:>9}  {:>10}  {:>10}\n", name.empty() ? "" : "\n",
                         row.name, row.reference, "", width, "time", "abs error", "rel error");
      name = row.name;
    }
    out += fmt::format("  {} {:{}}  {:>9}  {:>10.2e}  {:>10.2e}", line.pareto ? '*' : ' ', row.variant, width,
                       time_text(row.time_ns), row.max_abs_error, row.max_rel_error);
    if (row.failures != 0) out += fmt::format("  no answer: {} of {}", row.failures, row.asked);
    out += '\n';
  }
  return out + "\n* nothing of the same name is both faster and nearer\n";
}

std::string accuracy_csv(std::span<const AccuracyLine> lines) {
  std::string out = "name,variant,time_ns,max_abs_error,max_rel_error,reference,asked,failures,pareto\r\n";
  for (const auto& [row, pareto] : lines)
    out += fmt::format("{},{},{},{},{},{},{},{},{}\r\n", field(row.name), field(row.variant), row.time_ns,
                       row.max_abs_error, row.max_rel_error, field(row.reference), row.asked, row.failures,
                       pareto ? 1 : 0);
  return out;
}

std::string accuracy_json(std::span<const AccuracyLine> lines) {
  using Json = nlohmann::ordered_json;
  std::string out;
  for (const auto& [row, pareto] : lines) {
    const Json j{{"name", row.name},
                 {"variant", row.variant},
                 {"time_ns", row.time_ns},
                 {"max_abs_error", row.max_abs_error},
                 {"max_rel_error", row.max_rel_error},
                 {"reference", row.reference},
                 {"asked", row.asked},
                 {"failures", row.failures},
                 {"pareto", pareto}};
    out += j.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  }
  return out;
}

}  // namespace forager::tools
