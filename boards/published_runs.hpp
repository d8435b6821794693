#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace forager::boards {

// An experiment of the laboratory and what was published of it.
struct PublishedRun {
  std::string_view run;               // "1A"; also the name of its scene
  std::string_view scene;             // file in scenes/ without its ending
  std::uint32_t tags = 0;             // in place
  std::optional<std::uint32_t> read;  // different tags read; not published for chapter 4
  std::optional<double> duration_s;   // "about"
  bool stigmergic = false;
  bool in_fit = false;            // one of the fourteen figures of chapter 3
  bool winner_takes_all = false;  // sec. 4.8: only the antenna with the most new tags pulls
  std::string_view source;        // section of the thesis

  // Share of the tags read, per cent.
  [[nodiscard]] std::optional<double> coverage_percent() const {
    if (!read) return std::nullopt;
    return 100.0 * *read / tags;
  }
};
[[nodiscard]] std::span<const PublishedRun> published_runs();
// Null if there is no such run.
[[nodiscard]] const PublishedRun* published_run(std::string_view run);

// How much longer one mission took than another, from the text of sec. 3.6.
struct PublishedRatio {
  std::string_view longer;
  std::string_view base;
  double ratio = 0.0;
};
[[nodiscard]] std::span<const PublishedRatio> published_ratios();

// How near a simulation must come, per cent of coverage in points, durations relative.
struct ReproductionBounds {
  double rms_points = 3.5;
  double each_points = 8.0;
  double stigmergic_points = 3.0;
  double duration_share = 0.35;
};

}  // namespace forager::boards
