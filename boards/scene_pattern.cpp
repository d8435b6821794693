#include <fmt/format.h>

#include "boards/scene_sections.hpp"
#include "hal/units.hpp"

namespace forager::boards {
namespace {

// Less is as good as nothing: a millionth of a millionth of the power.
constexpr double kFaintest_db = -120.0;

std::vector<ScenePatternSample> read_cut(ConfigReader& radio, const char* key) {
  std::vector<ScenePatternSample> cut;
  const auto samples = radio.points(key, 2);
  if (!radio.has(key)) return cut;
  const auto refuse = [&](std::size_t i, std::string detail, std::string mend) {
    radio.complain(key, fmt::format("sample {}: {}", i + 1, detail), std::move(mend));
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double angle_deg = samples[i][0];
    const double gain_db = samples[i][1];
    if (!(angle_deg >= -180.0 && angle_deg <= 180.0))
      refuse(i, fmt::format("angle {}", angle_deg), "Allowed: -180 to 180 degrees off boresight.");
    if (i > 0 && !(angle_deg > samples[i - 1][0]))
      refuse(i, fmt::format("angle {} is not above {}", angle_deg, samples[i - 1][0]), "Sort by angle.");
    if (!(gain_db >= kFaintest_db && gain_db <= 0.0))
      refuse(i, fmt::format("gain {} dB", gain_db),
             fmt::format("Allowed: {} to 0, decibels against the strongest direction.", kFaintest_db));
    cut.push_back({hal::deg_to_rad(angle_deg), gain_db});
  }
  if (samples.size() < 2) {
    radio.complain(key, fmt::format("has {} samples", samples.size()), "Give two or more.");
  } else if (samples.front()[0] > 0.0 || samples.back()[0] < 0.0) {
    radio.complain(key, fmt::format("reaches from {} to {} degrees", samples.front()[0], samples.back()[0]),
                   "Boresight, 0, must lie within; outside the samples the antenna hears nothing.");
  }
  return cut;
}

}  // namespace

void read_pattern(ConfigReader& radio, SceneRadio& into) {
  into.pattern = radio.choice("pattern", into.pattern, {"cosine", "gaussian", "table"});
  const char* const kCuts[] = {"pattern_azimuth", "pattern_elevation"};
  if (into.pattern == "table")
    for (const char* key : kCuts) radio.require(key, "its samples, [[angle_deg, gain_db], ...]");
  // A scene may take a formula where the scene it lies on has a table.
  into.pattern_azimuth = read_cut(radio, kCuts[0]);
  into.pattern_elevation = read_cut(radio, kCuts[1]);
}

}  // namespace forager::boards
