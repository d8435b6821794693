#include "tools/reproduce_page.hpp"

#include "tools/page_frame.hpp"
#include "tools/report_markup.hpp"
#include "tools/reproduce_plots.hpp"

namespace forager::tools {
namespace {

using boards::ReproducedRun;
using boards::Reproduction;

std::string signed_points(std::optional<double> points) {
  return points ? fmt::format("{:+.1f}", *points) : std::string("–");
}

void put_row(std::string& out, const ReproducedRun& run) {
  put(out, "<tr><th scope=\"row\">{} <small>{}</small></th>", escape_markup(run.published.run),
      escape_markup(run.title));
  put_number(out, fmt::format("{}", run.published.tags));
  const auto published = run.published.coverage_percent();
  put_number(out, published ? fmt::format("{:.1f}", *published) : "–");
  put_number(out, fmt::format("{:.1f}", run.coverage_percent.median));
  put_number(out, fmt::format("{:.1f} – {:.1f}", run.coverage_percent.p5, run.coverage_percent.p95));
  put_number(out, signed_points(run.difference_points()));
  put_number(out, fmt::format("{:.0f}", run.duration_s.median));
  put_number(out, run.published.duration_s ? fmt::format("{:.0f}", *run.published.duration_s) : "–");
  out += "</tr>\n";
}

void put_table(std::string& out, const Reproduction& result) {
  begin_table(out, "Published and simulated",
              {{"Experiment", false},
               {"Tags"},
               {"Published, %"},
               {"Median, %"},
               {"5 – 95 %"},
               {"Difference, points"},
               {"Time, s"},
               {"Published, s"}});
  for (const ReproducedRun& run : result.runs) put_row(out, run);
  end_table(out);
}

void put_ratios(std::string& out, const Reproduction& result) {
  if (result.ratios.empty()) return;
  out +=
      "<section class=\"card full\">\n<h2>How much longer one mission takes than "
      "another</h2>\n<table><tbody>\n";
  for (const auto& ratio : result.ratios)
    put(out, "<tr><th scope=\"row\">{} over {}</th><td>published about {:.2f}, simulated {:.2f}</td></tr>\n",
        ratio.published.longer, ratio.published.base, ratio.published.ratio, ratio.simulated);
  out += "</tbody></table>\n</section>\n";
}

void put_complaints(std::string& out, const Reproduction& result) {
  const auto complaints = result.complaints();
  if (complaints.empty()) return;
  out += "<section class=\"card full\">\n<h2>Out of bounds</h2>\n<ul>\n";
  for (const std::string& complaint : complaints) put(out, "<li>{}</li>\n", escape_markup(complaint));
  out += "</ul>\n</section>\n";
}

void put_tiles(std::string& out, const Reproduction& result) {
  out += "<dl class=\"tiles\">\n";
  if (const auto rms = result.rms_points())
    put(out, "<div><dt>Root mean square difference</dt><dd>{:.2f} <small>points</small></dd></div>\n", *rms);
  put(out, "<div><dt>Experiments</dt><dd>{}</dd></div>\n", result.runs.size());
  if (!result.runs.empty())
    put(out, "<div><dt>Missions of each</dt><dd>{}</dd></div>\n", result.runs.front().seeds);
  out += "</dl>\n";
}

}  // namespace

std::string reproduction_page(const Reproduction& result) {
  std::string out;
  begin_page(out, "Published experiments, simulated");
  out +=
      "<header>\n<h1>Published experiments, simulated</h1>\n<p class=\"sub\">Share of the tags read, in per "
      "cent "
      "of those in place</p>\n";
  put_tiles(out, result);
  out += "</header>\n<main>\n<div class=\"grid\">\n";
  put(out, "<section class=\"card full\">\n<h2>Coverage</h2>\n{}</section>\n", draw_coverages(result));
  put_table(out, result);
  put_ratios(out, result);
  put_complaints(out, result);
  for (std::size_t i = 0; i < result.runs.size(); ++i)
    put(out, "<section class=\"card\">\n<h2>Tags against time, {}</h2>\n{}</section>\n",
        escape_markup(result.runs[i].published.run), draw_tags_against_time(result.runs[i], i));
  out += "</div>\n";
  end_page(out, "Times from switching on to the end. Bands from the 5 to the 95 % point over the seeds.");
  return out;
}

}  // namespace forager::tools
