#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "boards/published_runs.hpp"
#include "boards/scene.hpp"
#include "flight/mission.hpp"
#include "hal/error.hpp"

namespace forager::boards {

// Median with the 5 and 95 % points of a sample (linear between its ordered values).
struct Spread {
  double median = 0.0;
  double p5 = 0.0;
  double p95 = 0.0;
};
// The value below which a share (0..1) of the sample lies; 0 without values.
[[nodiscard]] double quantile(std::vector<double> values, double share);
[[nodiscard]] Spread spread_of(const std::vector<double>& values);

// One mission of an experiment.
struct ReproducedFlight {
  double coverage_percent = 0.0;
  double duration_s = 0.0;  // from switching on to stored and switched off
  flight::EndReason end = flight::EndReason::none;
  std::uint32_t crashes = 0;
  std::vector<std::uint32_t> tags_each_s;  // different tags heard by the end of second 0, 1, ...
};

// Flies a scene on emulated devices as fast as it goes. Errors: those of Run::prepare and of the inventory;
// timeout if it has not ended after two hours of its own time.
[[nodiscard]] hal::Result<ReproducedFlight> fly_reproduction(const Scene& scene, std::uint64_t seed);

// The spread of tags heard over all seeds at a moment.
struct TagsAtTime {
  double time_s = 0.0;
  Spread tags;
};

// One experiment over its seeds, beside what was published.
struct ReproducedRun {
  PublishedRun published;
  std::string title;
  std::uint64_t seeds = 0;
  Spread coverage_percent;
  Spread duration_s;
  std::uint32_t crashes = 0;  // of all seeds
  std::vector<TagsAtTime> curve;

  // Simulated median less published, points; nothing where nothing was published.
  [[nodiscard]] std::optional<double> difference_points() const;
  // Simulated median over published.
  [[nodiscard]] std::optional<double> duration_ratio() const;
};

struct ReproducedRatio {
  PublishedRatio published;
  double simulated = 0.0;  // of the medians
};

struct Reproduction {
  std::vector<ReproducedRun> runs;
  std::vector<ReproducedRatio> ratios;  // those of which both missions were flown

  [[nodiscard]] const ReproducedRun* run(std::string_view name) const;
  // Root mean square of the differences of the chapter 3 figures flown; nothing if none was.
  [[nodiscard]] std::optional<double> rms_points() const;
  // Sentences that say which bounds do not hold; empty if all do.
  [[nodiscard]] std::vector<std::string> complaints(const ReproductionBounds& bounds = {}) const;
};

struct ReproduceOptions {
  std::string folder = "scenes";
  std::uint64_t seeds = 20;       // 1 .. seeds
  std::vector<std::string> runs;  // empty: all
  // Changes every scene before it flies; for fits.
  std::function<void(Scene&)> change;
  // Missions flown so far, of how many.
  std::function<void(std::size_t, std::size_t, std::string_view)> progress;
};

// Flies the published experiments. The same scenes and seeds give the same figures. Errors: invalid_argument
// naming a run that was not published; those of load_scene and fly_reproduction.
[[nodiscard]] hal::Result<Reproduction> reproduce(const ReproduceOptions& options);

}  // namespace forager::boards
