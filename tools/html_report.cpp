#include "tools/html_report.hpp"

#include <algorithm>
#include <cmath>

#include "tools/report_map.hpp"
#include "tools/report_markup.hpp"
#include "tools/report_plots.hpp"
#include "tools/report_style.hpp"

namespace forager::tools {
namespace {

constexpr std::size_t kMaxEvents = 500;

struct Outcome {
  std::size_t tags = 0;  // in the world; 0 if not known
  std::size_t read = 0;
  double duration_s = 0.0;
  double path_m = 0.0;
};

Outcome outcome_of(const ReportData& data) {
  Outcome outcome;
  outcome.tags = data.tags.size();
  outcome.read = static_cast<std::size_t>(
      std::count_if(data.tags.begin(), data.tags.end(), [](const auto& tag) { return tag.read; }));
  if (data.totals) outcome = {data.totals->tags, data.totals->read};
  // On a robot nobody knows where the tags are: what was heard is all there is to say.
  if (data.tags.empty() && !data.tags_over_time.empty()) outcome.read = data.tags_over_time.back().count;
  outcome.duration_s = std::max(0.0, hal::to_seconds(data.ended - data.started));
  for (std::size_t i = 1; i < data.path.size(); ++i) {
    const double step = std::hypot(data.path[i].x - data.path[i - 1].x, data.path[i].y - data.path[i - 1].y);
    if (std::isfinite(step)) outcome.path_m += step;
  }
  if (data.path_m) outcome.path_m = *data.path_m;
  return outcome;
}

std::string percent(std::size_t part, std::size_t whole) {
  return fmt::format("{:.1f} %", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

std::string badge(flight::DecisionKind kind) {
  return fmt::format(
      "<svg viewBox=\"0 0 20 20\" aria-hidden=\"true\"><g class=\"decision {}\"><circle cx=\"10\" cy=\"10\" "
      "r=\"8\"/><text x=\"10\" y=\"13\">{}</text></g></svg>",
      style_class(kind), to_string(kind));
}

void put_tile(std::string& out, std::string_view name, std::string_view value, std::string_view note) {
  put(out, "<div><dt>{}</dt><dd>{} <small>{}</small></dd></div>\n", name, value, note);
}

void put_header(std::string& out, const ReportData& data, const Outcome& outcome) {
  put(out,
      "<header>\n<h1>{}</h1>\n<p class=\"sub\">Scene {} · policy {} · seed {}</p>\n<dl class=\"tiles\">\n",
      escape_markup(data.title.empty() ? "Inventory run " + data.scene : data.title),
      escape_markup(data.scene), escape_markup(data.policy), data.seed);
  if (outcome.tags != 0)
    put_tile(out, "Tags read", fmt::format("{}", outcome.read),
             fmt::format("of {} · {}", outcome.tags, percent(outcome.read, outcome.tags)));
  else
    put_tile(out, "Tags read", fmt::format("{}", outcome.read), "");
  put_tile(out, "Duration", fmt::format("{:.1f}", outcome.duration_s), "s");
  put_tile(out, "Path", fmt::format("{:.1f}", outcome.path_m), "m");
  put_tile(out, "Decisions", fmt::format("{}", data.decisions.size()), "");
  out += "</dl>\n</header>\n";
}

void put_map_legend(std::string& out) {
  constexpr std::string_view kOpen = "<li><svg viewBox=\"0 0 20 20\" aria-hidden=\"true\">";
  put(out, "<ul class=\"legend\">\n");
  put(out, "{}<g class=\"read\"><circle cx=\"10\" cy=\"10\" r=\"3\"/></g></svg>tag read</li>\n", kOpen);
  put(out, "{}<g class=\"unread\"><circle cx=\"10\" cy=\"10\" r=\"4\"/></g></svg>tag not read</li>\n", kOpen);
  put(out, "{}<rect class=\"box\" x=\"2\" y=\"5\" width=\"16\" height=\"10\"/></svg>shelf or wall</li>\n",
      kOpen);
  put(out, "{}<path class=\"path\" d=\"M1 13C7 3 12 17 19 7\"/></svg>path</li>\n", kOpen);
  put(out, "{}<circle class=\"start\" cx=\"10\" cy=\"10\" r=\"8\"/></svg>start</li>\n", kOpen);
  for (const flight::DecisionKind kind : kDecisionKinds)
    put(out, "<li>{}{}</li>\n", badge(kind), meaning(kind));
  put(out, "{}<g class=\"decision f\"><circle cx=\"10\" cy=\"10\" r=\"3\"/></g></svg>", kOpen);
  put(out,
      "a decision without room for its letter; the point of a mark shows the heading chosen</li>\n</ul>\n");
}

void put_figure(std::string& out, std::string_view title, const std::string& svg) {
  if (!svg.empty()) put(out, "<section class=\"card\">\n<h2>{}</h2>\n{}</section>\n", title, svg);
}

void put_row(std::string& out, std::string_view name, std::string_view value) {
  put(out, "<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escape_markup(name), escape_markup(value));
}

void put_facts(std::string& out, const ReportData& data) {
  if (data.facts.empty()) return;
  put(out, "<section class=\"card full\">\n<h2>Facts</h2>\n<table class=\"facts\"><tbody>\n");
  for (const auto& [name, value] : data.facts) put_row(out, name, value);
  out += "</tbody></table>\n</section>\n";
}

void put_closing(std::string& out, const ReportData& data, const Outcome& outcome) {
  put(out, "<section class=\"card\">\n<h2>Outcome</h2>\n<table class=\"closing\"><tbody>\n");
  put_row(out, "Tags read", fmt::format("{}", outcome.read));
  if (outcome.tags != 0) {
    put_row(out, "Tags not read", fmt::format("{} of {}", outcome.tags - outcome.read, outcome.tags));
    put_row(out, "Share read", percent(outcome.read, outcome.tags));
  }
  std::uint64_t reads = 0;
  for (const auto& port : data.ports) reads += port.reads;
  if (!data.ports.empty()) put_row(out, "Reads", fmt::format("{}", reads));
  put_row(out, "Duration", fmt::format("{:.1f} s", outcome.duration_s));
  put_row(out, "Path", fmt::format("{:.1f} m", outcome.path_m));
  if (!data.end_reason.empty()) put_row(out, "Ended by", data.end_reason);
  out += "</tbody></table>\n</section>\n";
}

void put_decision_table(std::string& out, const ReportData& data) {
  if (data.decisions.empty()) return;
  put(out,
      "<section class=\"card\">\n<h2>Decisions</h2>\n<table class=\"kinds\"><thead><tr><th "
      "scope=\"col\">Kind</th>"
      "<th scope=\"col\" class=\"number\">Times</th><th scope=\"col\" class=\"number\">New tags behind "
      "it</th></tr>"
      "</thead><tbody>\n");
  for (const flight::DecisionKind kind : kDecisionKinds) {
    std::size_t times = 0;
    std::uint64_t tags = 0;
    for (const auto& decision : data.decisions) {
      if (decision.kind != kind) continue;
      ++times;
      tags += decision.new_tags;
    }
    put(out, "<tr><td class=\"key\">{}{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td></tr>\n",
        badge(kind), meaning(kind), times, tags);
  }
  out += "</tbody></table>\n</section>\n";
}

void put_events(std::string& out, const ReportData& data) {
  if (data.events.empty()) return;
  put(out, "<section class=\"card full\">\n<h2>Events</h2>\n<ol class=\"events\" tabindex=\"0\">\n");
  const std::size_t shown = std::min(data.events.size(), kMaxEvents);
  for (std::size_t i = 0; i < shown; ++i)
    put(out, "<li><span>{:.1f} s</span><p>{}</p></li>\n", hal::to_seconds(data.events[i].at - data.started),
        escape_markup(data.events[i].text));
  if (shown < data.events.size())
    put(out, "<li><span>…</span><p>and {} more, which the journal holds</p></li>\n",
        data.events.size() - shown);
  out += "</ol>\n</section>\n";
}

void put_map(std::string& out, const ReportMap& map) {
  put(out, "<section class=\"card{}\">\n<h2>Map</h2>\n{}", map.wide ? " full" : "", map.svg);
  put_map_legend(out);
  out += "</section>\n";
}

void put_figures(std::string& out, const ReportData& data) {
  put_figure(out, "Tags over time", draw_tags_over_time(data));
  put_figure(out, "Decisions over time", draw_decisions_over_time(data));
  put_figure(out, "Tags by port", draw_ports(data));
}

// Two columns of about equal height: a tall map fills one of them, a wide one stands above both.
void put_main(std::string& out, const ReportData& data, const Outcome& outcome) {
  const ReportMap map = draw_map(data);
  const bool beside = !map.svg.empty() && !map.wide;
  out += "<main>\n<div class=\"grid\">\n";
  if (map.wide) put_map(out, map);
  out += "<div class=\"stack\">\n";
  if (beside) {
    put_map(out, map);
    put_closing(out, data, outcome);
  } else {
    put_figures(out, data);
  }
  out += "</div>\n<div class=\"stack\">\n";
  if (beside)
    put_figures(out, data);
  else
    put_closing(out, data, outcome);
  put_decision_table(out, data);
  out += "</div>\n";
  put_facts(out, data);
  put_events(out, data);
  out += "</div>\n</main>\n";
}

}  // namespace

std::string render_html_report(const ReportData& data) {
  const Outcome outcome = outcome_of(data);
  std::string out;
  put(out,
      "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n<meta "
      "charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>{} · {} · seed "
      "{}</title>\n<style>{}</style>\n</head>\n<body>\n",
      escape_markup(data.scene), escape_markup(data.policy), data.seed, report_style());
  put_header(out, data, outcome);
  put_main(out, data, outcome);
  out +=
      "<footer>Written by forager. World frame: x forward at the start, y left, metres. Times in seconds "
      "from "
      "the start of the run.</footer>\n</body>\n</html>\n";
  return out;
}

}  // namespace forager::tools
