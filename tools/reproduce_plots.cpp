#include "tools/reproduce_plots.hpp"

#include <algorithm>

#include "tools/report_markup.hpp"

namespace forager::tools {
namespace {

using boards::ReproducedRun;
using boards::TagsAtTime;

constexpr double kWidth = 600.0;
constexpr double kLeft = 60.0;
constexpr double kRight = 570.0;

double coverage_x(double percent) {
  return kLeft + std::clamp(percent, 0.0, 100.0) / 100.0 * (kRight - kLeft);
}

void put_coverage(std::string& out, const ReproducedRun& run, double y) {
  const auto published = run.published.coverage_percent();
  put(out, "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>", units(kLeft - 10), units(y + 4),
      escape_markup(run.published.run));
  put(out,
      "<path class=\"path\" d=\"M{} {}H{}\"/><g class=\"read\"><circle cx=\"{}\" cy=\"{}\" "
      "r=\"4\"><title>{}: "
      "simulated {:.1f} %</title></circle></g>",
      units(coverage_x(run.coverage_percent.p5)), units(y), units(coverage_x(run.coverage_percent.p95)),
      units(coverage_x(run.coverage_percent.median)), units(y), escape_markup(run.published.run),
      run.coverage_percent.median);
  if (published)
    put(out,
        "<circle class=\"start\" cx=\"{}\" cy=\"{}\" r=\"7\"><title>{}: published {:.1f} %</title></circle>",
        units(coverage_x(*published)), units(y), escape_markup(run.published.run), *published);
  out += "\n";
}

class CurvePlot {
 public:
  CurvePlot(const ReproducedRun& run, std::size_t index) : run_(&run), index_(index) {
    last_s_ = std::max(run.curve.back().time_s, 1.0);
    for (const TagsAtTime& point : run.curve) highest_ = std::max(highest_, point.tags.p95);
    highest_ = 1.06 * std::max(highest_, static_cast<double>(run.published.tags));
  }

  [[nodiscard]] std::string draw() const {
    std::string out;
    put(out,
        "<svg class=\"plot\" viewBox=\"0 0 {0} {1}\" role=\"img\" "
        "aria-labelledby=\"curve-{2}-title\">\n<title "
        "id=\"curve-{2}-title\">Tags against time, {3}: {4:.0f} after {5:.0f} seconds</title>\n",
        units(kWidth), units(kBottom + 42), index_, escape_markup(run_->published.run),
        run_->curve.back().tags.median, run_->curve.back().time_s);
    draw_axes(out);
    draw_lines(out);
    out += "\n</svg>\n";
    return out;
  }

 private:
  static constexpr double kTop = 10.0;
  static constexpr double kBottom = 230.0;

  [[nodiscard]] double x(double t_s) const { return kLeft + t_s / last_s_ * (kRight - kLeft); }
  [[nodiscard]] double y(double tags) const { return kBottom - tags / highest_ * (kBottom - kTop); }

  void draw_axes(std::string& out) const {
    out += "<g class=\"axis\">";
    const auto seconds = axis_ticks(0.0, last_s_, 8);
    for (const double tick : seconds)
      put(out, "<path d=\"M{0} {1}V{2}\"/><text x=\"{0}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>",
          units(x(tick)), units(kBottom), units(kTop), units(kBottom + 16), tick_label(tick, seconds));
    const auto counts = axis_ticks(0.0, highest_, 5);
    for (const double tick : counts)
      put(out, "<path d=\"M{1} {0}H{2}\"/><text x=\"{3}\" y=\"{4}\" text-anchor=\"end\">{5}</text>",
          units(y(tick)), units(kLeft), units(kRight), units(kLeft - 6), units(y(tick) + 4),
          tick_label(tick, counts));
    put(out, "<text class=\"unit\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">time [s]</text></g>\n",
        units((kLeft + kRight) / 2), units(kBottom + 34));
  }

  void draw_lines(std::string& out) const {
    out += "<polygon class=\"box\" points=\"";
    for (const TagsAtTime& p : run_->curve) put(out, "{},{} ", units(x(p.time_s)), units(y(p.tags.p95)));
    for (auto p = run_->curve.rbegin(); p != run_->curve.rend(); ++p)
      put(out, "{},{} ", units(x(p->time_s)), units(y(p->tags.p5)));
    out += "\"/>\n<polyline class=\"curve all\" points=\"";
    for (const TagsAtTime& p : run_->curve) put(out, "{},{} ", units(x(p.time_s)), units(y(p.tags.median)));
    out += "\"/>\n";
    const auto line = [&](double tags, std::string_view text) {
      put(out, "<path class=\"total\" d=\"M{} {}H{}\"/><text x=\"{}\" y=\"{}\">{}</text>\n", units(kLeft),
          units(y(tags)), units(kRight), units(kLeft + 6), units(y(tags) - 4), text);
    };
    if (run_->published.read)
      line(*run_->published.read, fmt::format("published {}", *run_->published.read));
    else
      line(run_->published.tags, fmt::format("in place {}", run_->published.tags));
  }

  const ReproducedRun* run_;
  std::size_t index_;
  double last_s_ = 1.0;
  double highest_ = 1.0;
};

}  // namespace

std::string draw_coverages(const boards::Reproduction& result) {
  if (result.runs.empty()) return {};
  constexpr double kTop = 8.0;
  constexpr double kRow = 22.0;
  const double bottom = kTop + kRow * static_cast<double>(result.runs.size());
  std::string out;
  put(out,
      "<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-labelledby=\"coverage-title\">\n<title "
      "id=\"coverage-title\">Published coverage as rings, simulated as dots on their range</title>\n<g "
      "class=\"axis\">",
      units(kWidth), units(bottom + 42));
  for (int percent = 0; percent <= 100; percent += 20)
    put(out, "<path d=\"M{0} {1}V{2}\"/><text x=\"{0}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>",
        units(coverage_x(percent)), units(bottom), units(kTop), units(bottom + 16), percent);
  put(out, "<text class=\"unit\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">tags read [%]</text></g>\n",
      units((kLeft + kRight) / 2), units(bottom + 34));
  double y = kTop + 0.5 * kRow;
  for (const ReproducedRun& run : result.runs) {
    put_coverage(out, run, y);
    y += kRow;
  }
  out +=
      "</svg>\n<ul class=\"legend\"><li><svg viewBox=\"0 0 20 20\" aria-hidden=\"true\"><circle "
      "class=\"start\" "
      "cx=\"10\" cy=\"10\" r=\"7\"/></svg>published</li><li><svg viewBox=\"0 0 20 20\" "
      "aria-hidden=\"true\"><g "
      "class=\"read\"><circle cx=\"10\" cy=\"10\" r=\"4\"/></g></svg>simulated, median</li></ul>\n";
  return out;
}

std::string draw_tags_against_time(const ReproducedRun& run, std::size_t index) {
  return run.curve.empty() ? std::string() : CurvePlot(run, index).draw();
}

}  // namespace forager::tools
