#include <algorithm>

#include "tools/calibrate_output.hpp"
#include "tools/report_markup.hpp"
#include "tools/report_style.hpp"

namespace forager::tools {
namespace {

using boards::Calibration;
using boards::CalibrationResidual;

constexpr double kWidth = 600.0;
constexpr double kLeft = 60.0;
constexpr double kRight = 570.0;
constexpr double kTop = 10.0;
constexpr double kBottom = 250.0;

double share(double count, double slices) { return slices > 0.0 ? count / slices : 0.0; }

// Heard share of the slices over range: observed as dots, expected as a line.
std::string draw_shares(const Calibration& result) {
  if (result.residuals.empty()) return {};
  const double far_m = std::max(result.residuals.back().to_m, 0.1);
  double most = 0.01;
  for (const CalibrationResidual& r : result.residuals)
    most = std::max({most, share(r.seen, r.slices), share(r.expected, r.slices)});
  most *= 1.1;
  const auto x = [&](const CalibrationResidual& r) {
    return kLeft + 0.5 * (r.from_m + r.to_m) / far_m * (kRight - kLeft);
  };
  const auto y = [&](double value) { return kBottom - value / most * (kBottom - kTop); };
  std::string out;
  put(out,
      "<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-labelledby=\"shares\">\n<title "
      "id=\"shares\">Share of the time slices in which a tag was heard, over range</title>\n<g "
      "class=\"axis\">",
      units(kWidth), units(kBottom + 42));
  const auto metres = axis_ticks(0.0, far_m, 8);
  for (const double tick : metres)
    put(out, "<path d=\"M{0} {1}V{2}\"/><text x=\"{0}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>",
        units(kLeft + tick / far_m * (kRight - kLeft)), units(kBottom), units(kTop), units(kBottom + 16),
        tick_label(tick, metres));
  const auto shares = axis_ticks(0.0, most, 5);
  for (const double tick : shares)
    put(out, "<path d=\"M{1} {0}H{2}\"/><text x=\"{3}\" y=\"{4}\" text-anchor=\"end\">{5}</text>",
        units(y(tick)), units(kLeft), units(kRight), units(kLeft - 6), units(y(tick) + 4),
        tick_label(tick, shares));
  put(out,
      "<text class=\"unit\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">range on boresight [m]</text></g>\n",
      units((kLeft + kRight) / 2), units(kBottom + 34));
  out += "<polyline class=\"curve all\" points=\"";
  for (const CalibrationResidual& r : result.residuals)
    put(out, "{},{} ", units(x(r)), units(y(share(r.expected, r.slices))));
  out += "\"/>\n<g class=\"read\">";
  for (const CalibrationResidual& r : result.residuals)
    put(out,
        "<circle cx=\"{}\" cy=\"{}\" r=\"4\"><title>{:.2f} to {:.2f} m: heard {:.0f}, expected "
        "{:.1f}</title></circle>",
        units(x(r)), units(y(share(r.seen, r.slices))), r.from_m, r.to_m, r.seen, r.expected);
  out += "</g>\n</svg>\n";
  return out;
}

void put_parameters(std::string& out, const Calibration& result) {
  out +=
      "<section class=\"card\">\n<h2>Parameters</h2>\n<table><thead><tr><th scope=\"col\">Name</th><th "
      "scope=\"col\" "
      "class=\"number\">Value</th><th scope=\"col\" class=\"number\">95 % "
      "interval</th></tr></thead><tbody>\n";
  for (const auto& p : result.parameters)
    put(out,
        "<tr><th scope=\"row\">{}</th><td class=\"number\">{:.3f} {}</td><td class=\"number\">{}</td></tr>\n",
        escape_markup(p.name), p.value, escape_markup(p.unit), interval_text(p));
  out += "</tbody></table>\n</section>\n";
}

void put_residuals(std::string& out, const Calibration& result) {
  out +=
      "<section class=\"card full\">\n<h2>Residuals</h2>\n<table><thead><tr><th scope=\"col\">Range, "
      "m</th><th "
      "scope=\"col\" class=\"number\">Slices</th><th scope=\"col\" class=\"number\">Heard</th><th "
      "scope=\"col\" "
      "class=\"number\">Expected</th><th scope=\"col\" class=\"number\">Residual</th></tr></thead><tbody>\n";
  for (const CalibrationResidual& r : result.residuals)
    put(out,
        "<tr><td>{:.2f} – {:.2f}</td><td class=\"number\">{:.0f}</td><td class=\"number\">{:.0f}</td><td "
        "class=\"number\">{:.1f}</td><td class=\"number\">{:+.2f}</td></tr>\n",
        r.from_m, r.to_m, r.slices, r.seen, r.expected, r.standardised);
  out += "</tbody></table>\n</section>\n";
}

}  // namespace

std::string calibration_page(const Calibration& result) {
  std::string out;
  put(out,
      "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n<meta "
      "charset=\"utf-8\"/>\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<title>Radio calibration</title>\n<style>{}</style>\n</head>\n<body>\n<header>\n<h1>Radio "
      "calibration</h1>\n<p class=\"sub\">{} reads of {} tags</p>\n</header>\n<main>\n<div class=\"grid\">\n",
      report_style(), result.reads, result.tags);
  put_parameters(out, result);
  put(out, "<section class=\"card\">\n<h2>Heard share over range</h2>\n{}</section>\n", draw_shares(result));
  put_residuals(out, result);
  out +=
      "</div>\n</main>\n<footer>Written by forager. Dots: heard. Line: expected. Residual: heard less "
      "expected in "
      "standard deviations.</footer>\n</body>\n</html>\n";
  return out;
}

}  // namespace forager::tools
