#include "tools/reproduce_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

using boards::ReproducedRun;
using boards::Reproduction;
using Json = nlohmann::ordered_json;

constexpr std::size_t kCurveLines = 10;

std::string run_line(const ReproducedRun& run) {
  const auto published = run.published.coverage_percent();
  const auto difference = run.difference_points();
  const auto ratio = run.duration_ratio();
  std::string line =
      fmt::format("{:<6}{:>5} {:>10} {:>10.1f} {:>6.1f} -{:>6.1f} {:>11} {:>9.0f}", run.published.run,
                  run.published.tags, published ? fmt::format("{:.1f}", *published) : "-",
                  run.coverage_percent.median, run.coverage_percent.p5, run.coverage_percent.p95,
                  difference ? fmt::format("{:+.1f}", *difference) : "-", run.duration_s.median);
  if (ratio) line += fmt::format(" {:>10.0f} {:>6.2f}", *run.published.duration_s, *ratio);
  if (run.crashes > 0) line += fmt::format("  {} crashes", run.crashes);
  return line + "\n";
}

void append_curve(std::string& out, const ReproducedRun& run) {
  out += fmt::format("Tags against time, {}: {}\n", run.published.run, one_line(run.title));
  out += fmt::format("{:>8} {:>8} {:>8} {:>8}\n", "time s", "median", "5 %", "95 %");
  const std::size_t stride = std::max<std::size_t>(1, run.curve.size() / kCurveLines);
  for (std::size_t i = 0; i < run.curve.size(); ++i)
    if (i % stride == 0 || i + 1 == run.curve.size())
      out += fmt::format("{:>8.0f} {:>8.0f} {:>8.0f} {:>8.0f}\n", run.curve[i].time_s,
                         run.curve[i].tags.median, run.curve[i].tags.p5, run.curve[i].tags.p95);
}

// The figure of the fit that is furthest off.
const ReproducedRun* worst_of(const Reproduction& result) {
  const ReproducedRun* worst = nullptr;
  for (const ReproducedRun& run : result.runs) {
    if (!run.published.in_fit || !run.difference_points()) continue;
    if (worst == nullptr || std::abs(*run.difference_points()) > std::abs(*worst->difference_points()))
      worst = &run;
  }
  return worst;
}

bool tags_against_time(const ReproducedRun& run) { return !run.published.read.has_value(); }

Json row_of(const ReproducedRun& run) {
  Json row;
  const auto published = run.published.coverage_percent();
  const auto difference = run.difference_points();
  row["run"] = run.published.run;
  row["published"] = published ? Json(*published) : Json();
  row["median"] = run.coverage_percent.median;
  row["p5"] = run.coverage_percent.p5;
  row["p95"] = run.coverage_percent.p95;
  row["difference"] = difference ? Json(*difference) : Json();
  row["duration_s"] = run.duration_s.median;
  row["published_duration_s"] = run.published.duration_s ? Json(*run.published.duration_s) : Json();
  row["tags"] = run.published.tags;
  row["published_read"] = run.published.read ? Json(*run.published.read) : Json();
  row["seeds"] = run.seeds;
  row["crashes"] = run.crashes;
  row["in_fit"] = run.published.in_fit;
  row["source"] = run.published.source;
  if (tags_against_time(run)) {
    row["tags_against_time"] = Json::array();
    for (const auto& point : run.curve)
      row["tags_against_time"].push_back({{"time_s", point.time_s},
                                          {"median", point.tags.median},
                                          {"p5", point.tags.p5},
                                          {"p95", point.tags.p95}});
  }
  return row;
}

}  // namespace

std::string reproduction_table(const Reproduction& result) {
  std::string out =
      fmt::format("{:<6}{:>5} {:>10} {:>10} {:>14} {:>11} {:>9} {:>10} {:>6}\n", "run", "tags", "published",
                  "simulated", "5 - 95 %", "difference", "time", "published", "ratio");
  out += fmt::format("{:<6}{:>5} {:>10} {:>10} {:>14} {:>11} {:>9} {:>10} {:>6}\n", "", "", "%", "%", "%",
                     "points", "s", "s", "");
  for (const ReproducedRun& run : result.runs) out += run_line(run);
  for (const auto& ratio : result.ratios)
    out += fmt::format("time of {} over {}: published about {:.2f}, simulated {:.2f} ({:.2f} of it)\n",
                       ratio.published.longer, ratio.published.base, ratio.published.ratio, ratio.simulated,
                       ratio.simulated / ratio.published.ratio);
  for (const ReproducedRun& run : result.runs)
    if (tags_against_time(run)) append_curve(out, run);
  if (const auto rms = result.rms_points())
    if (const ReproducedRun* worst = worst_of(result))
      out += fmt::format("Root mean square difference {:.2f} points; worst {} with {:+.1f}.\n", *rms,
                         worst->published.run, *worst->difference_points());
  for (const std::string& complaint : result.complaints())
    out += fmt::format("Out of bounds: {}.\n", complaint);
  return out;
}

std::string reproduction_json(const Reproduction& result) {
  std::string out;
  for (const ReproducedRun& run : result.runs) out += row_of(run).dump() + "\n";
  Json closing;
  const auto rms = result.rms_points();
  const ReproducedRun* worst = worst_of(result);
  closing["rms_points"] = rms ? Json(*rms) : Json();
  closing["worst_run"] = worst != nullptr ? Json(worst->published.run) : Json();
  closing["worst_points"] = worst != nullptr ? Json(*worst->difference_points()) : Json();
  closing["figures"] = std::count_if(result.runs.begin(), result.runs.end(),
                                     [](const auto& run) { return run.published.in_fit; });
  closing["duration_ratios"] = Json::array();
  for (const auto& ratio : result.ratios)
    closing["duration_ratios"].push_back({{"longer", ratio.published.longer},
                                          {"base", ratio.published.base},
                                          {"published", ratio.published.ratio},
                                          {"simulated", ratio.simulated}});
  closing["out_of_bounds"] = result.complaints();
  return out + closing.dump() + "\n";
}

}  // namespace forager::tools
