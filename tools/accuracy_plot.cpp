#include "tools/accuracy_plot.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/report_markup.hpp"

namespace forager::tools {
namespace {

constexpr double kWidth = 600.0;
constexpr double kHeight = 330.0;
constexpr double kLeft = 64.0;
constexpr double kRight = 586.0;
constexpr double kTop = 14.0;
constexpr double kBottom = 280.0;

// A logarithmic axis over whole decades. What is 0 lies on its lower end, with a decade to itself.
class Axis {
 public:
  Axis(const std::vector<double>& values, double from, double to) : from_(from), to_(to) {
    double low = HUGE_VAL;
    double high = 0.0;
    for (const double value : values) {
      if (!(value > 0.0) || !std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
    if (high == 0.0) low = high = 1.0;
    zero_ = std::any_of(values.begin(), values.end(), [](double v) { return !(v > 0.0); });
    first_ = static_cast<int>(std::floor(std::log10(low))) - (zero_ ? 1 : 0);
    last_ = std::max(static_cast<int>(std::ceil(std::log10(high))), first_ + 1);
  }
  [[nodiscard]] double at(double value) const {
    const double decade = value > 0.0 ? std::log10(value) : first_;
    return from_ + (std::clamp(decade, double{1.0} * first_, double{1.0} * last_) - first_) /
                       (last_ - first_) * (to_ - from_);
  }
  // Every decade, or every second, third, ... so that labels have room.
  template <class Visit>
  void ticks(int most, Visit visit) const {
    const int step = std::max(1, (last_ - first_ + most - 1) / most);
    for (int decade = first_; decade <= last_; decade += step)
      visit(at(std::pow(10.0, decade)), zero_ && decade == first_ ? std::string("0") : label(decade));
  }

 private:
  static std::string label(int decade) {
    return decade >= 0 && decade <= 3 ? fmt::format("{}", std::pow(10.0, decade))
                                      : fmt::format("1e{}", decade);
  }
  double from_;
  double to_;
  int first_ = 0;
  int last_ = 1;
  bool zero_ = false;
};

void put_axes(std::string& out, const Axis& time, const Axis& error) {
  out += "<g class=\"axis\">\n";
  time.ticks(8, [&](double x, const std::string& text) {
    put(out, "<path d=\"M{0} {1}V{2}\"/><text x=\"{0}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>",
        units(x), units(kBottom), units(kTop), units(kBottom + 17), text);
  });
  error.ticks(9, [&](double y, const std::string& text) {
    put(out, "<path d=\"M{0} {1}H{2}\"/><text x=\"{3}\" y=\"{4}\" text-anchor=\"end\">{5}</text>",
        units(kLeft), units(y), units(kRight), units(kLeft - 7), units(y + 4), text);
  });
  put(out, "\n<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">time of one, ns</text>",
      units((kLeft + kRight) / 2), units(kHeight - 8));
  put(out,
      "<text transform=\"translate(14 {}) rotate(-90)\" text-anchor=\"middle\">largest absolute "
      "error</text>\n</g>\n",
      units((kTop + kBottom) / 2));
}

void put_front(std::string& out, std::span<const AccuracyLine> lines, const Axis& time, const Axis& error) {
  std::vector<const boards::AccuracyRow*> front;
  for (const AccuracyLine& line : lines)
    if (line.pareto) front.push_back(&line.row);
  std::sort(front.begin(), front.end(), [](const auto* a, const auto* b) { return a->time_ns < b->time_ns; });
  std::string path;
  for (const auto* row : front)
    path += fmt::format("{}{} {}", path.empty() ? "M" : fmt::format("H{}V", units(time.at(row->time_ns))),
                        path.empty() ? units(time.at(row->time_ns)) : std::string(),
                        units(error.at(row->max_abs_error)));
  if (front.size() > 1) put(out, "<path class=\"total\" d=\"{}\"/>\n", path);
}

}  // namespace

std::string draw_accuracy(std::span<const AccuracyLine> lines, std::size_t index) {
  std::vector<double> times;
  std::vector<double> errors;
  for (const AccuracyLine& line : lines) {
    if (!(line.row.time_ns > 0.0)) continue;
    times.push_back(line.row.time_ns);
    errors.push_back(line.row.max_abs_error);
  }
  if (times.empty()) return {};
  const Axis time(times, kLeft + 8, kRight - 8);
  const Axis error(errors, kBottom - 8, kTop + 8);
  std::string out;
  put(out,
      "<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-labelledby=\"plot-{}\">\n<title "
      "id=\"plot-{}\">Error over time: {}</title>\n",
      units(kWidth), units(kHeight), index, index, escape_markup(lines.front().row.name));
  put_axes(out, time, error);
  put_front(out, lines, time, error);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto& row = lines[i].row;
    if (!(row.time_ns > 0.0)) continue;
    const double x = time.at(row.time_ns);
    const double y = error.at(row.max_abs_error);
    put(out,
        "<g class=\"{}\"><title>{}: {:.4g} ns, {:.3g}</title><circle cx=\"{}\" cy=\"{}\" r=\"{}\"/></g><text "
        "x=\"{}\" y=\"{}\">{}</text>\n",
        lines[i].pareto ? "read" : "unread", escape_markup(row.variant), row.time_ns, row.max_abs_error,
        units(x), units(y), lines[i].pareto ? 5 : 4, units(x + 7), units(y - 5), i + 1);
  }
  return out + "</svg>\n";
}

}  // namespace forager::tools
