#include "boards/reproduce.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace forager::boards {
namespace {

// Enough to draw; short missions show every second.
constexpr std::size_t kCurvePoints = 300;

// Missions that have landed keep what they have.
std::vector<TagsAtTime> curve_of(const std::vector<ReproducedFlight>& flights) {
  std::size_t length = 0;
  for (const ReproducedFlight& f : flights) length = std::max(length, f.tags_each_s.size());
  std::vector<TagsAtTime> curve;
  if (length == 0) return curve;
  const std::size_t stride = length / kCurvePoints + 1;
  std::vector<double> tags;
  const auto add = [&](std::size_t second) {
    tags.clear();
    for (const ReproducedFlight& f : flights)
      if (!f.tags_each_s.empty()) tags.push_back(f.tags_each_s[std::min(second, f.tags_each_s.size() - 1)]);
    curve.push_back({static_cast<double>(second), spread_of(tags)});
  };
  for (std::size_t second = 0; second < length; second += stride) add(second);
  if ((length - 1) % stride != 0) add(length - 1);
  return curve;
}

ReproducedRun summed_up(const PublishedRun& published, const Scene& scene,
                        const std::vector<ReproducedFlight>& flights) {
  ReproducedRun run;
  run.published = published;
  run.title = scene.title;
  run.seeds = flights.size();
  std::vector<double> coverages;
  std::vector<double> durations;
  for (const ReproducedFlight& f : flights) {
    coverages.push_back(f.coverage_percent);
    durations.push_back(f.duration_s);
    run.crashes += f.crashes;
  }
  run.coverage_percent = spread_of(coverages);
  run.duration_s = spread_of(durations);
  run.curve = curve_of(flights);
  return run;
}

hal::Result<std::vector<const PublishedRun*>> chosen(const std::vector<std::string>& names) {
  std::vector<const PublishedRun*> runs;
  for (const PublishedRun& run : published_runs())
    if (names.empty() || std::find(names.begin(), names.end(), run.run) != names.end()) runs.push_back(&run);
  for (const std::string& name : names) {
    if (published_run(name) != nullptr) continue;
    std::string known;
    for (const PublishedRun& run : published_runs())
      known += fmt::format("{}{}", known.empty() ? "" : ", ", run.run);
    return hal::fail(hal::ErrorCode::invalid_argument, "published runs", "choose",
                     fmt::format("no run '{}'", name), fmt::format("There are {}.", known));
  }
  return runs;
}

}  // namespace

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(place);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (place - static_cast<double>(low)) * (values[high] - values[low]);
}

Spread spread_of(const std::vector<double>& values) {
  return {quantile(values, 0.5), quantile(values, 0.05), quantile(values, 0.95)};
}

std::optional<double> ReproducedRun::difference_points() const {
  const auto was = published.coverage_percent();
  if (!was) return std::nullopt;
  return coverage_percent.median - *was;
}

std::optional<double> ReproducedRun::duration_ratio() const {
  if (!published.duration_s) return std::nullopt;
  return duration_s.median / *published.duration_s;
}

const ReproducedRun* Reproduction::run(std::string_view name) const {
  const auto found =
      std::find_if(runs.begin(), runs.end(), [name](const auto& r) { return r.published.run == name; });
  return found == runs.end() ? nullptr : &*found;
}

std::optional<double> Reproduction::rms_points() const {
  double sum = 0.0;
  int count = 0;
  for (const ReproducedRun& run : runs) {
    const auto difference = run.difference_points();
    if (!run.published.in_fit || !difference) continue;
    sum += *difference * *difference;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return std::sqrt(sum / count);
}

std::vector<std::string> Reproduction::complaints(const ReproductionBounds& bounds) const {
  std::vector<std::string> out;
  const auto rms = rms_points();
  if (rms && !(*rms <= bounds.rms_points))
    out.push_back(fmt::format("root mean square {:.2f} points, above {}", *rms, bounds.rms_points));
  const auto check_time = [&](std::string_view what, double share) {
    if (!(std::abs(share - 1.0) <= bounds.duration_share))
      out.push_back(fmt::format("{} is {:.2f} of the published one, beyond {:.0f} %", what, share,
                                100.0 * bounds.duration_share));
  };
  for (const ReproducedRun& run : runs) {
    if (!run.published.in_fit) continue;
    const double bound = run.published.stigmergic ? bounds.stigmergic_points : bounds.each_points;
    if (const auto difference = run.difference_points(); difference && !(std::abs(*difference) <= bound))
      out.push_back(
          fmt::format("{} is {:+.1f} points off, beyond {}", run.published.run, *difference, bound));
    if (const auto share = run.duration_ratio())
      check_time(fmt::format("the duration of {}", run.published.run), *share);
  }
  for (const ReproducedRatio& ratio : ratios)
    check_time(fmt::format("the ratio of {} to {}", ratio.published.longer, ratio.published.base),
               ratio.simulated / ratio.published.ratio);
  return out;
}

hal::Result<Reproduction> reproduce(const ReproduceOptions& options) {
  const auto runs = chosen(options.runs);
  if (!runs) return hal::fail(runs.error());
  Reproduction result;
  const std::size_t missions = runs->size() * options.seeds;
  std::size_t flown = 0;
  for (const PublishedRun* published : *runs) {
    auto scene = load_scene(fmt::format("{}/{}.toml", options.folder, published->scene));
    if (!scene) return hal::fail(std::move(scene).error());
    if (published->winner_takes_all) scene->mission.winner_takes_all = true;
    if (options.change) options.change(*scene);
    std::vector<ReproducedFlight> flights;
    for (std::uint64_t seed = 1; seed <= options.seeds; ++seed) {
      if (options.progress) options.progress(flown++, missions, published->run);
      auto flight = fly_reproduction(*scene, seed);
      if (!flight) return hal::fail(std::move(flight).error());
      flights.push_back(std::move(*flight));
    }
    result.runs.push_back(summed_up(*published, *scene, flights));
  }
  for (const PublishedRatio& ratio : published_ratios()) {
    const ReproducedRun* longer = result.run(ratio.longer);
    const ReproducedRun* base = result.run(ratio.base);
    if (longer != nullptr && base != nullptr && base->duration_s.median > 0.0)
      result.ratios.push_back({ratio, longer->duration_s.median / base->duration_s.median});
  }
  return result;
}

}  // namespace forager::boards
