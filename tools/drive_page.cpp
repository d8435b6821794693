#include <algorithm>
#include <cmath>

#include "hal/units.hpp"
#include "tools/drive_output.hpp"
#include "tools/report_markup.hpp"

namespace forager::tools {
namespace {

constexpr double kScale = 100.0;  // drawing units per metre
constexpr double kRim = 0.8;      // metres around everything

struct Frame {
  double left = 0.0, right = 0.0, low = 0.0, high = 0.0;
  void take(double x, double y) {
    left = std::min(left, x);
    right = std::max(right, x);
    low = std::min(low, y);
    high = std::max(high, y);
  }
  [[nodiscard]] std::string x(double v) const { return units(kScale * (v - left)); }
  [[nodiscard]] std::string y(double v) const { return units(kScale * (high - v)); }
};

Frame frame_of(const boards::DriveScene& scene, const boards::DriveResult& run) {
  Frame f{scene.start.position.x, scene.start.position.x, scene.start.position.y, scene.start.position.y};
  for (const auto& pose : scene.path) f.take(pose.x_m, pose.y_m);
  for (const auto& box : scene.obstacles) {
    f.take(box.min_x, box.min_y);
    f.take(box.max_x, box.max_y);
  }
  for (const auto& point : run.track) f.take(point.x, point.y);
  f.left -= kRim;
  f.right += kRim;
  f.low -= kRim;
  f.high += kRim;
  return f;
}

void put_way(std::string& out, const Frame& f, const boards::DriveResult& run) {
  put(out, "<polyline class=\"way\" points=\"");
  for (const auto& p : run.track) put(out, "{},{} ", f.x(p.x), f.y(p.y));
  put(out, "\"/>\n");
  // The axle every so often: heading and what it sweeps.
  for (std::size_t i = 0; i < run.track.size(); i += 10) {
    const auto& p = run.track[i];
    const double dx = -0.5 * std::sin(p.yaw_rad);
    const double dy = 0.5 * std::cos(p.yaw_rad);
    put(out, "<line class=\"axle\" x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"><title>{:.1f} s</title></line>\n",
        f.x(p.x - dx), f.y(p.y - dy), f.x(p.x + dx), f.y(p.y + dy), p.at_s);
  }
}

void put_path(std::string& out, const Frame& f, const boards::DriveScene& scene) {
  std::string points;
  for (const auto& pose : scene.path) put(points, "{},{} ", f.x(pose.x_m), f.y(pose.y_m));
  put(out, "<polyline class=\"corridor\" style=\"stroke-width:{}\" points=\"{}\"/>\n",
      units(2.0 * kScale * scene.corridor_half_width_m), points);
  put(out, "<polyline class=\"path\" points=\"{}\"/>\n", points);
  const auto mission = boards::drive_mission(scene);
  if (!mission) return;
  for (const auto& step : mission->steps)
    put(out, "<circle class=\"step\" cx=\"{}\" cy=\"{}\" r=\"5\"/>\n", f.x(step.x_m), f.y(step.y_m));
}

}  // namespace

std::string drive_page(const boards::DriveScene& scene, const boards::DriveResult& run) {
  const Frame f = frame_of(scene, run);
  std::string out;
  put(out,
      "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\"><head><meta "
      "charset=\"utf-8\"/>"
      "<title>{0}</title>\n<style>body{{font:15px "
      "sans-serif;margin:2em;max-width:70em}}svg{{width:100%;background:#fafafa}}"
      "polyline{{fill:none}}.corridor{{stroke:#e4eef6;stroke-linejoin:round;stroke-linecap:round}}"
      ".path{{stroke:#8ab;stroke-width:2;stroke-dasharray:6 5}}.way{{stroke:#c33;stroke-width:3}}"
      ".axle{{stroke:#c33;stroke-width:1;opacity:.35}}.step{{fill:#47a}}.box{{fill:#777}}td{{padding:.1em "
      "1em .1em 0}}"
      "</style></head>\n<body><h1>{0}</h1>\n<p>{1}</p>\n",
      escape_markup(scene.name), escape_markup(scene.title));
  put(out, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" role=\"img\">\n",
      units(kScale * (f.right - f.left)), units(kScale * (f.high - f.low)));
  put_path(out, f, scene);
  for (const auto& box : scene.obstacles)
    put(out, "<rect class=\"box\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", f.x(box.min_x),
        f.y(box.max_y), units(kScale * (box.max_x - box.min_x)), units(kScale * (box.max_y - box.min_y)));
  put_way(out, f, run);
  put(out, "</svg>\n<table>\n");
  const auto row = [&](std::string_view name, const std::string& value) {
    put(out, "<tr><td>{}</td><td>{}</td></tr>\n", name, escape_markup(value));
  };
  row("seed", fmt::format("{}", run.seed));
  row("ended", fmt::format("{}: {}", to_string(run.end), run.detail));
  row("position error", fmt::format("{:.3f} m", run.position_error_m));
  row("heading error", fmt::format("{:.1f} degrees", hal::rad_to_deg(run.heading_error_rad)));
  row("time", fmt::format("{:.1f} s", run.time_s));
  row("steps", fmt::format("{} of {}, {} turns, {} drives", run.steps_done, run.steps, run.stats.turns,
                           run.stats.drives));
  row("farthest from the path",
      fmt::format("{:.2f} m of {:.2f} m", run.corridor_m, scene.corridor_half_width_m));
  row("least clearance", fmt::format("{:.2f} m", run.clearance_m));
  put(out, "</table></body></html>\n");
  return out;
}

}  // namespace forager::tools
