#include "tools/report_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "hal/units.hpp"
#include "tools/report_markup.hpp"

namespace forager::tools {
namespace {

using flight::Decision;
using flight::DecisionKind;

struct Point {
  double x = 0.0;
  double y = 0.0;
};
double gap(Point a, Point b) { return std::hypot(a.x - b.x, a.y - b.y); }

constexpr double kLeft = 46.0;
constexpr double kBottom = 44.0;
constexpr double kTop = 10.0;
constexpr double kRight = 12.0;
constexpr double kMarkRadius = 7.5;
constexpr double kMarkRoom = 2.0 * kMarkRadius + 1.5;  // between the centres of two lettered marks
constexpr std::size_t kMaxPathPoints = 3000;

// World metres to drawing units.
class Frame {
 public:
  void include(double x_m, double y_m) {
    if (!std::isfinite(x_m) || !std::isfinite(y_m)) return;
    low_ = any_ ? Point{std::min(low_.x, x_m), std::min(low_.y, y_m)} : Point{x_m, y_m};
    high_ = any_ ? Point{std::max(high_.x, x_m), std::max(high_.y, y_m)} : Point{x_m, y_m};
    any_ = true;
  }
  void fit() {
    constexpr double kMarginM = 0.6;
    low_ = {low_.x - kMarginM, low_.y - kMarginM};
    high_ = {high_.x + kMarginM, high_.y + kMarginM};
    wide_ = width_m() > 1.7 * height_m();
    scale_ = std::min((wide_ ? 1000.0 : 540.0) / width_m(), (wide_ ? 560.0 : 680.0) / height_m());
  }
  [[nodiscard]] bool any() const { return any_; }
  [[nodiscard]] bool wide() const { return wide_; }
  [[nodiscard]] double width_m() const { return high_.x - low_.x; }
  [[nodiscard]] double height_m() const { return high_.y - low_.y; }
  [[nodiscard]] Point low() const { return low_; }
  [[nodiscard]] Point high() const { return high_; }
  [[nodiscard]] double x(double x_m) const { return kLeft + (x_m - low_.x) * scale_; }
  [[nodiscard]] double y(double y_m) const { return kTop + (high_.y - y_m) * scale_; }
  [[nodiscard]] Point at(double x_m, double y_m) const { return {x(x_m), y(y_m)}; }
  [[nodiscard]] bool holds(Point p) const {
    return p.x > x(low_.x) + kMarkRadius && p.x < x(high_.x) - kMarkRadius &&
           p.y > y(high_.y) + kMarkRadius && p.y < y(low_.y) - kMarkRadius;
  }

 private:
  bool any_ = false;
  bool wide_ = false;
  double scale_ = 1.0;
  Point low_;
  Point high_;
};

Frame frame_of(const ReportData& data) {
  Frame frame;
  for (const auto& box : data.boxes) {
    frame.include(box.min.x, box.min.y);
    frame.include(box.max.x, box.max.y);
  }
  for (const auto& tag : data.tags) frame.include(tag.position.x, tag.position.y);
  for (const auto& sample : data.path) frame.include(sample.x, sample.y);
  for (const auto& decision : data.decisions)
    frame.include(decision.from.position.x, decision.from.position.y);
  if (frame.any()) frame.fit();
  return frame;
}

void draw_axes(std::string& out, const Frame& frame) {
  // One step for both axes, so that the grid is of squares.
  const double longer = std::max(frame.width_m(), frame.height_m());
  const auto reference = axis_ticks(0.0, longer, frame.wide() ? 16 : 10);
  const double step = reference.size() > 1 ? reference[1] : 1.0;
  const auto along = [&](double low, double high) {
    std::vector<double> ticks;
    for (double i = std::ceil(low / step); i * step <= high; ++i) ticks.push_back(i * step);
    return ticks;
  };
  const double left = frame.x(frame.low().x);
  const double right = frame.x(frame.high().x);
  const double bottom = frame.y(frame.low().y);
  const double top = frame.y(frame.high().y);
  put(out, "<g class=\"axis\">");
  for (const double tick : along(frame.low().x, frame.high().x)) {
    put(out, "<path d=\"M{0} {1}V{2}\"/><text x=\"{0}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>",
        units(frame.x(tick)), units(bottom), units(top), units(bottom + 16), tick_label(tick, reference));
  }
  for (const double tick : along(frame.low().y, frame.high().y)) {
    put(out, "<path d=\"M{1} {0}H{2}\"/><text x=\"{3}\" y=\"{4}\" text-anchor=\"end\">{5}</text>",
        units(frame.y(tick)), units(left), units(right), units(left - 6), units(frame.y(tick) + 4),
        tick_label(tick, reference));
  }
  put(out, "<text class=\"unit\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">x [m], forward at the start</text>",
      units((left + right) / 2), units(bottom + 36));
  put(out,
      "<text class=\"unit\" transform=\"translate(12 {}) rotate(-90)\" text-anchor=\"middle\">y [m], "
      "left</text>",
      units((top + bottom) / 2));
  put(out, "</g>\n");
}

void draw_boxes(std::string& out, const ReportData& data, const Frame& frame) {
  put(out, "<g class=\"boxes\">");
  for (const auto& box : data.boxes) {
    if (!is_finite(box.min) || !is_finite(box.max)) continue;
    const Point corner = frame.at(std::min(box.min.x, box.max.x), std::max(box.min.y, box.max.y));
    put(out, "<rect class=\"box\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>", units(corner.x),
        units(corner.y), units(std::abs(frame.x(box.max.x) - frame.x(box.min.x))),
        units(std::abs(frame.y(box.max.y) - frame.y(box.min.y))));
  }
  put(out, "</g>\n");
}

// The unread ones last: they are few, and what the reader of the page looks for.
void draw_tags(std::string& out, const ReportData& data, const Frame& frame) {
  for (const bool read : {true, false}) {
    put(out, "<g class=\"{}\">", read ? "read" : "unread");
    for (const auto& tag : data.tags) {
      if (tag.read != read || !is_finite(tag.position)) continue;
      const Point p = frame.at(tag.position.x, tag.position.y);
      put(out, "<circle cx=\"{}\" cy=\"{}\" r=\"{}\"/>", units(p.x), units(p.y), read ? "2" : "3.2");
    }
    put(out, "</g>\n");
  }
}

std::vector<Point> thin_path(const ReportData& data, const Frame& frame) {
  std::vector<Point> points;
  for (const auto& sample : data.path) {
    if (!std::isfinite(sample.x) || !std::isfinite(sample.y)) continue;
    const Point p = frame.at(sample.x, sample.y);
    constexpr double kVisible = 0.8;
    if (points.empty() || gap(points.back(), p) >= kVisible) points.push_back(p);
  }
  if (points.size() <= kMaxPathPoints) return points;
  std::vector<Point> fewer;
  const std::size_t stride = points.size() / kMaxPathPoints + 1;
  for (std::size_t i = 0; i < points.size(); i += stride) fewer.push_back(points[i]);
  fewer.push_back(points.back());
  return fewer;
}

void draw_path(std::string& out, const std::vector<Point>& points) {
  if (points.empty()) return;
  put(out, "<polyline class=\"path\" points=\"");
  for (const Point p : points) put(out, "{},{} ", units(p.x), units(p.y));
  out.back() = '"';
  put(out, "/>\n<circle class=\"start\" cx=\"{}\" cy=\"{}\" r=\"11\"><title>start</title></circle>\n",
      units(points.front().x), units(points.front().y));
}

// Where each decision's letter goes: at its place, beside it on a leader, or nowhere (a dot remains).
class Letters {
 public:
  explicit Letters(const Frame& frame) : frame_(&frame) {}

  // Forward steps are many and say little: they get a letter only where there is room right there.
  std::optional<Point> place(Point at, double heading_rad, DecisionKind kind) {
    if (free(at)) return take(at);
    if (kind == DecisionKind::forward) return std::nullopt;
    for (const double distance : {1.1, 1.7, 2.4, 3.2}) {
      // To the sides of the heading first, where the path does not run.
      for (const double turn : {0.5, -0.5, 0.75, -0.75, 0.25, -0.25, 1.0, 0.0}) {
        const double angle = heading_rad + turn * hal::kPi;
        const Point beside{at.x + distance * kMarkRoom * std::cos(angle),
                           at.y - distance * kMarkRoom * std::sin(angle)};
        if (free(beside)) return take(beside);
      }
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] bool free(Point p) const {
    return frame_->holds(p) &&
           std::none_of(taken_.begin(), taken_.end(), [&](Point other) { return gap(other, p) < kMarkRoom; });
  }
  std::optional<Point> take(Point p) {
    taken_.push_back(p);
    return p;
  }
  const Frame* frame_;
  std::vector<Point> taken_;
};

void draw_decision(std::string& out, const Decision& decision, Point at, std::optional<Point> mark,
                   hal::Instant started) {
  put(out, "<g class=\"decision {}\"><title>{}</title>", style_class(decision.kind),
      escape_markup(describe_decision(decision, started)));
  if (!mark) {
    put(out, "<circle cx=\"{}\" cy=\"{}\" r=\"2.6\"/></g>\n", units(at.x), units(at.y));
    return;
  }
  if (gap(*mark, at) > 0.0) {
    put(out, "<path class=\"leader\" d=\"M{} {}L{} {}\"/><circle cx=\"{}\" cy=\"{}\" r=\"2.6\"/>",
        units(at.x), units(at.y), units(mark->x), units(mark->y), units(at.x), units(at.y));
  }
  const double c = std::cos(decision.heading_rad);
  const double s = -std::sin(decision.heading_rad);  // the drawing's y points down
  constexpr double kNeedle = kMarkRadius + 5.5;
  if (decision.kind != DecisionKind::land && std::isfinite(c))
    put(out, "<path class=\"needle\" d=\"M{} {}L{} {}L{} {}z\"/>", units(mark->x - s * 4.5),
        units(mark->y + c * 4.5), units(mark->x + c * kNeedle), units(mark->y + s * kNeedle),
        units(mark->x + s * 4.5), units(mark->y - c * 4.5));
  put(out, "<circle cx=\"{0}\" cy=\"{1}\" r=\"{2}\"/><text x=\"{0}\" y=\"{3}\">{4}</text></g>\n",
      units(mark->x), units(mark->y), units(kMarkRadius), units(mark->y + 3.0), to_string(decision.kind));
}

void draw_decisions(std::string& out, const ReportData& data, const Frame& frame) {
  // The rare and telling ones choose their place first, but all are drawn in the order they were taken.
  Letters letters(frame);
  std::vector<std::optional<Point>> marks(data.decisions.size());
  constexpr std::array kFirstCome{DecisionKind::land,       DecisionKind::turn_back, DecisionKind::turn_left,
                                  DecisionKind::turn_right, DecisionKind::stay,      DecisionKind::forward};
  for (const DecisionKind kind : kFirstCome) {
    for (std::size_t i = 0; i < data.decisions.size(); ++i) {
      const Decision& decision = data.decisions[i];
      if (decision.kind != kind || !is_finite(decision.from.position)) continue;
      marks[i] = letters.place(frame.at(decision.from.position.x, decision.from.position.y),
                               decision.heading_rad, kind);
    }
  }
  put(out, "<g class=\"decisions\">\n");
  for (const bool lettered : {false, true}) {
    for (std::size_t i = 0; i < data.decisions.size(); ++i) {
      const Decision& decision = data.decisions[i];
      if (marks[i].has_value() != lettered || !is_finite(decision.from.position)) continue;
      draw_decision(out, decision, frame.at(decision.from.position.x, decision.from.position.y), marks[i],
                    data.started);
    }
  }
  put(out, "</g>\n");
}

}  // namespace

ReportMap draw_map(const ReportData& data) {
  const Frame frame = frame_of(data);
  if (!frame.any()) return {};
  const auto drawn_unread = static_cast<std::size_t>(
      std::count_if(data.tags.begin(), data.tags.end(), [](const auto& tag) { return !tag.read; }));
  const std::size_t tags = data.totals ? data.totals->tags : data.tags.size();
  const std::size_t unread = data.totals ? tags - data.totals->read : drawn_unread;
  ReportMap map;
  map.wide = frame.wide();
  put(map.svg,
      "<svg class=\"map\" viewBox=\"0 0 {} {}\" role=\"img\" aria-labelledby=\"map-title map-desc\">\n"
      "<title id=\"map-title\">Map of the run</title>\n"
      "<desc id=\"map-desc\">Plan view, x to the right and y up, in metres: {} shelves or walls, {} tags of "
      "which {} "
      "were not read, the path flown and {} decisions.</desc>\n",
      units(frame.x(frame.high().x) + kRight), units(frame.y(frame.low().y) + kBottom), data.boxes.size(),
      tags, unread, data.decisions.size());
  draw_axes(map.svg, frame);
  draw_boxes(map.svg, data, frame);
  draw_tags(map.svg, data, frame);
  draw_path(map.svg, thin_path(data, frame));
  draw_decisions(map.svg, data, frame);
  put(map.svg, "</svg>\n");
  return map;
}

}  // namespace forager::tools
