#include "tools/accuracy_plot.hpp"
#include "tools/accuracy_table.hpp"
#include "tools/report_markup.hpp"
#include "tools/report_style.hpp"

namespace forager::tools {
namespace {

void put_table(std::string& out, std::span<const AccuracyLine> lines) {
  out +=
      "<table><thead><tr><th scope=\"col\">Way</th><th scope=\"col\" class=\"number\">Time, ns</th>"
      "<th scope=\"col\" class=\"number\">Absolute error</th><th scope=\"col\" class=\"number\">Relative "
      "error</th><th scope=\"col\" class=\"number\">No answer</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto& row = lines[i].row;
    put(out, "<tr><th scope=\"row\">{}. {}{}</th>", i + 1, escape_markup(row.variant),
        lines[i].pareto ? " <strong>· front</strong>" : "");
    for (const std::string& text :
         {row.time_ns > 0.0 ? fmt::format("{:.4g}", row.time_ns) : std::string("–"),
          fmt::format("{:.2e}", row.max_abs_error), fmt::format("{:.2e}", row.max_rel_error),
          row.asked == 0 ? std::string("–") : fmt::format("{} of {}", row.failures, row.asked)})
      put(out, "<td class=\"number\">{}</td>", text);
    out += "</tr>\n";
  }
  out += "</tbody></table>\n";
}

void put_group(std::string& out, std::span<const AccuracyLine> lines, std::size_t index) {
  put(out, "<section class=\"card full\">\n<h2>{}</h2>\n<p class=\"sub\">Errors against: {}</p>\n{}",
      escape_markup(lines.front().row.name), escape_markup(lines.front().row.reference),
      draw_accuracy(lines, index));
  put_table(out, lines);
  out += "</section>\n";
}

}  // namespace

std::string accuracy_page(std::span<const AccuracyLine> lines) {
  std::string out;
  put(out,
      "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n<meta "
      "charset=\"utf-8\"/>\n<meta name=\"viewport\" content=\"width=device-width, "
      "initial-scale=1\"/>\n<title>Run time against error</title>\n<style>{}</style>\n</head>\n<body>\n",
      report_style());
  out +=
      "<header>\n<h1>Run time against error</h1>\n<p class=\"sub\">Every way to compute something, measured "
      "turn by "
      "turn on one machine, with its largest error against the exact answer. Filled marks and the dashed "
      "line: "
      "the Pareto front, beyond which nothing is both faster and nearer.</p>\n</header>\n<main "
      "class=\"grid\">\n";
  std::size_t index = 0;
  for (std::size_t first = 0; first < lines.size(); ++index) {
    std::size_t last = first + 1;
    while (last < lines.size() && lines[last].row.name == lines[first].row.name) ++last;
    put_group(out, lines.subspan(first, last - first), index);
    first = last;
  }
  return out + "</main>\n</body>\n</html>\n";
}

}  // namespace forager::tools
