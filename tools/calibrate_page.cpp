#include <algorithm>

#include "tools/calibrate_output.hpp"
#include "tools/page_frame.hpp"
#include "tools/report_markup.hpp"

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
  begin_table(out, "Parameters", {{"Name", false}, {"Value"}, {"95 % interval"}}, false);
  for (const auto& p : result.parameters) {
    put(out, "<tr><th scope=\"row\">{}</th>", escape_markup(p.name));
    put_number(out, fmt::format("{:.3f} {}", p.value, escape_markup(p.unit)));
    put_number(out, interval_text(p));
    out += "</tr>\n";
  }
  end_table(out);
}

void put_residuals(std::string& out, const Calibration& result) {
  begin_table(out, "Residuals", {{"Range, m", false}, {"Slices"}, {"Heard"}, {"Expected"}, {"Residual"}});
  for (const CalibrationResidual& r : result.residuals) {
    put(out, "<tr><td>{:.2f} – {:.2f}</td>", r.from_m, r.to_m);
    put_number(out, fmt::format("{:.0f}", r.slices));
    put_number(out, fmt::format("{:.0f}", r.seen));
    put_number(out, fmt::format("{:.1f}", r.expected));
    put_number(out, fmt::format("{:+.2f}", r.standardised));
    out += "</tr>\n";
  }
  end_table(out);
}

void put_misplaced(std::string& out, const Calibration& result) {
  if (result.misplaced.empty()) return;
  const auto place = [](hal::Vec3 p) { return fmt::format("({:.2f}, {:.2f}, {:.2f})", p.x, p.y, p.z); };
  begin_table(out, "Tags that are not where the list has them",
              {{"EPC", false}, {"Listed at"}, {"Heard strongest from"}, {"Reads"}});
  for (const boards::MisplacedTag& tag : result.misplaced) {
    put(out, "<tr><th scope=\"row\">{}</th>", escape_markup(tag.epc));
    put_number(out, place(tag.listed));
    put_number(out, place(tag.heard_from));
    put_number(out, fmt::format("{}", tag.reads));
    out += "</tr>\n";
  }
  end_table(out);
}

}  // namespace

std::string calibration_page(const Calibration& result) {
  std::string out;
  begin_page(out, "Radio calibration");
  put(out,
      "<header>\n<h1>Radio calibration</h1>\n<p class=\"sub\">{} reads of {} tags</p>\n</header>\n<main>\n"
      "<div class=\"grid\">\n",
      result.reads, result.tags);
  put_parameters(out, result);
  put(out, "<section class=\"card\">\n<h2>Heard share over range</h2>\n{}</section>\n", draw_shares(result));
  put_residuals(out, result);
  put_misplaced(out, result);
  out += "</div>\n";
  end_page(out, "Dots: heard. Line: expected. Residual: heard less expected in standard deviations.");
  return out;
}

}  // namespace forager::tools
