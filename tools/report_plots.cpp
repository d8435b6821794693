#include "tools/report_plots.hpp"

#include <algorithm>
#include <cmath>

#include "tools/report_markup.hpp"

namespace forager::tools {
namespace {

// Both plots over time share these, so that one can be read below the other.
constexpr double kWidth = 600.0;
constexpr double kLeft = 46.0;
constexpr double kRight = 484.0;
constexpr std::size_t kMaxCurvePoints = 600;

class TimeAxis {
 public:
  explicit TimeAxis(const ReportData& data) : started_(data.started) {
    hal::Instant end = data.ended;
    if (!data.tags_over_time.empty()) end = std::max(end, data.tags_over_time.back().at);
    for (const auto& decision : data.decisions) end = std::max(end, decision.at);
    length_s_ = std::max(hal::to_seconds(end - data.started), 1.0);
  }
  [[nodiscard]] double x(hal::Instant t) const { return x(hal::to_seconds(t - started_)); }
  [[nodiscard]] double x(double t_s) const {
    return kLeft + std::clamp(t_s / length_s_, 0.0, 1.0) * (kRight - kLeft);
  }
  void draw(std::string& out, double top, double bottom) const {
    const auto ticks = axis_ticks(0.0, length_s_, 8);
    for (const double tick : ticks)
      put(out, "<path d=\"M{0} {1}V{2}\"/><text x=\"{0}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>",
          units(x(tick)), units(bottom), units(top), units(bottom + 16), tick_label(tick, ticks));
    put(out, "<text class=\"unit\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">time [s]</text>",
        units((kLeft + kRight) / 2), units(bottom + 34));
  }

 private:
  hal::Instant started_;
  double length_s_ = 1.0;
};

struct EndLabel {
  double y = 0.0;
  std::string style;
  std::string text;
};

// Pushes the labels at the ends of the curves apart, keeping their order, within [top, bottom].
void spread(std::vector<EndLabel>& labels, double top, double bottom) {
  constexpr double kRoom = 17.0;
  std::stable_sort(labels.begin(), labels.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
  double next = top;
  for (EndLabel& label : labels) {
    label.y = std::max(label.y, next);
    next = label.y + kRoom;
  }
  double limit = bottom;
  for (auto label = labels.rbegin(); label != labels.rend(); ++label) {
    label->y = std::min(label->y, limit);
    limit = label->y - kRoom;
  }
}

class CountPlot {
 public:
  explicit CountPlot(const ReportData& data) : data_(&data), time_(data) {
    for (const auto& sample : data.tags_over_time) highest_ = std::max(highest_, double{1.0} * sample.count);
    const std::size_t most = data.totals ? data.totals->read : data.tags.size();
    highest_ = 1.06 * std::max(highest_, static_cast<double>(most));
  }

  std::string draw() {
    std::string out;
    const auto& last = data_->tags_over_time.back();
    put(out,
        "<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-labelledby=\"time-title time-desc\">\n"
        "<title id=\"time-title\">Tags over time</title>\n"
        "<desc id=\"time-desc\">{} distinct tags after {:.1f} seconds.</desc>\n",
        units(kWidth), units(kBottom + 42), last.count, hal::to_seconds(last.at - data_->started));
    draw_axes(out);
    draw_total(out);
    const std::size_t ports = std::min(last.per_port.size(), data_->ports.size());
    for (std::size_t port = 0; port < ports; ++port) {
      const std::string style = port_class(port);
      draw_curve(out, style, [port](const auto& sample) {
        return port < sample.per_port.size() ? sample.per_port[port] : 0U;
      });
      label(last.per_port[port], style, data_->ports[port].name);
    }
    draw_curve(out, "all", [](const auto& sample) { return sample.count; });
    label(last.count, "all", "all");
    spread(labels_, kTop + 6, kBottom + 2);
    for (const EndLabel& end : labels_)
      put(out, "<text class=\"end {}\" x=\"{}\" y=\"{}\">{}</text>", end.style, units(kRight + 6),
          units(end.y + 4), escape_markup(end.text));
    out += "\n</svg>\n";
    return out;
  }

 private:
  static constexpr double kTop = 12.0;
  static constexpr double kBottom = 262.0;

  [[nodiscard]] double y(double count) const { return kBottom - count / highest_ * (kBottom - kTop); }

  void draw_axes(std::string& out) const {
    put(out, "<g class=\"axis\">");
    time_.draw(out, kTop, kBottom);
    const auto ticks = axis_ticks(0.0, highest_, 6);
    for (const double tick : ticks)
      if (tick == std::floor(tick))  // half a tag is no tag
        put(out, "<path d=\"M{1} {0}H{2}\"/><text x=\"{3}\" y=\"{4}\" text-anchor=\"end\">{5}</text>",
            units(y(tick)), units(kLeft), units(kRight), units(kLeft - 6), units(y(tick) + 4),
            tick_label(tick, ticks));
    put(out,
        "<text class=\"unit\" transform=\"translate(11 {}) rotate(-90)\" "
        "text-anchor=\"middle\">tags</text></g>\n",
        units((kTop + kBottom) / 2));
  }

  void draw_total(std::string& out) {
    if (data_->tags.empty()) return;
    const double total = static_cast<double>(data_->tags.size());
    put(out, "<path class=\"total\" d=\"M{} {}H{}\"/>\n", units(kLeft), units(y(total)), units(kRight));
    labels_.push_back({y(total), "total", fmt::format("in place {}", data_->tags.size())});
  }

  template <class Count>
  void draw_curve(std::string& out, const std::string& style, Count&& count) const {
    const auto& samples = data_->tags_over_time;
    const std::size_t stride = samples.size() / kMaxCurvePoints + 1;
    put(out, "<polyline class=\"curve {}\" points=\"", style);
    for (std::size_t i = 0; i < samples.size(); i += stride)
      put(out, "{},{} ", units(time_.x(samples[i].at)), units(y(count(samples[i]))));
    put(out, "{},{}\"/>\n", units(time_.x(samples.back().at)), units(y(count(samples.back()))));
  }

  void label(std::uint32_t count, const std::string& style, const std::string& name) {
    labels_.push_back({y(count), style, fmt::format("{} {}", name, count)});
  }

  const ReportData* data_;
  TimeAxis time_;
  double highest_ = 1.0;
  std::vector<EndLabel> labels_;
};

}  // namespace

std::string port_class(std::size_t index) { return fmt::format("p{}", index % 8); }

std::string draw_tags_over_time(const ReportData& data) {
  return data.tags_over_time.empty() ? std::string() : CountPlot(data).draw();
}

std::string draw_decisions_over_time(const ReportData& data) {
  if (data.decisions.empty()) return {};
  constexpr double kTop = 6.0;
  constexpr double kRow = 21.0;
  const double bottom = kTop + kRow * std::size(kDecisionKinds);
  const TimeAxis time(data);
  std::string out;
  put(out,
      "<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-labelledby=\"kinds-title kinds-desc\">\n"
      "<title id=\"kinds-title\">Decisions over time</title>\n"
      "<desc id=\"kinds-desc\">One row per kind of decision, one tick per decision.</desc>\n<g "
      "class=\"axis\">",
      units(kWidth), units(bottom + 42));
  time.draw(out, kTop, bottom);
  double row = kTop;
  for (const flight::DecisionKind kind : kDecisionKinds) {
    const auto count = std::count_if(data.decisions.begin(), data.decisions.end(),
                                     [kind](const auto& decision) { return decision.kind == kind; });
    put(out, "<path d=\"M{} {}H{}\"/><text class=\"kind\" x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>",
        units(kLeft), units(row + kRow), units(kRight), units(kLeft - 8), units(row + 15), to_string(kind));
    put(out, "<text x=\"{}\" y=\"{}\">{} ×</text>", units(kRight + 6), units(row + 15), count);
    row += kRow;
  }
  out += "</g>\n";
  for (const auto& decision : data.decisions) {
    const auto index =
        static_cast<double>(std::find(std::begin(kDecisionKinds), std::end(kDecisionKinds), decision.kind) -
                            std::begin(kDecisionKinds));
    put(out, "<path class=\"tick {}\" d=\"M{} {}v{}\"><title>{}</title></path>\n", style_class(decision.kind),
        units(time.x(decision.at)), units(kTop + kRow * index + 4), units(kRow - 7),
        escape_markup(describe_decision(decision, data.started)));
  }
  out += "</svg>\n";
  return out;
}

std::string draw_ports(const ReportData& data) {
  if (data.ports.empty()) return {};
  constexpr double kRow = 34.0;
  constexpr double kBarLeft = 110.0;
  constexpr double kBarRight = 420.0;
  std::uint32_t most = 1;
  for (const auto& port : data.ports) most = std::max(most, port.new_tags);
  std::string out;
  put(out,
      "<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-labelledby=\"ports-title ports-desc\">\n"
      "<title id=\"ports-title\">Tags by port</title>\n"
      "<desc id=\"ports-desc\">How many tags each antenna heard first, and its reads.</desc>\n",
      units(kWidth), units(kRow * static_cast<double>(data.ports.size()) + 6));
  double top = 3.0;
  for (std::size_t i = 0; i < data.ports.size(); ++i) {
    const auto& port = data.ports[i];
    const double length = (kBarRight - kBarLeft) * port.new_tags / most;
    put(out,
        "<text class=\"name\" x=\"{}\" y=\"{}\" text-anchor=\"end\">{} <tspan class=\"faint\">port "
        "{}</tspan></text>"
        "<rect class=\"bar {}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"2\"/>"
        "<text class=\"value\" x=\"{}\" y=\"{}\">{} <tspan class=\"faint\">of {} reads</tspan></text>\n",
        units(kBarLeft - 10), units(top + 21), escape_markup(port.name), port.port, port_class(i),
        units(kBarLeft), units(top + 5), units(length), units(kRow - 12), units(kBarLeft + length + 8),
        units(top + 21), port.new_tags, port.reads);
    top += kRow;
  }
  out += "</svg>\n";
  return out;
}

}  // namespace forager::tools
