// An antenna's measured pattern in a scene: taken strictly, and heard in what the reader reads.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "boards/calibration.hpp"
#include "boards/sim_air.hpp"
#include "mocks/detection.hpp"
#include "tests/boards/flown_mission.hpp"

namespace forager::boards {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kScene = R"(
scene = { name = "x" }
reader = { session = "S0", port = [{ port = 1, bearing_deg = 0 }] }
mission = { policy = "stigmergy" }
)";

hal::Result<Scene> scene_with(const std::string& radio) {
  const auto node = parse_config(kScene + ("[world.radio]\n" + radio), "x.toml");
  if (!node) return hal::fail(node.error());
  return read_scene(*node, "x.toml");
}

std::string complaint(const std::string& azimuth) {
  const auto scene =
      scene_with("pattern = \"table\"\npattern_elevation = [[-90, -20], [0, 0], [90, -20]]\n" + azimuth);
  return scene ? "taken" : describe(scene.error());
}

// The laboratory's beam as a table: cos^2 with its nulls at 70 degrees.
std::string cosine_cut(double step_deg) {
  std::string cut = "[";
  for (double angle = -70.0; angle <= 70.0 + 1e-9; angle += step_deg) {
    const double amplitude = std::cos(0.5 * hal::kPi * angle / 70.0);
    cut += fmt::format("[{:.4f}, {:.6f}],", angle,
                       std::max(-120.0, 20.0 * std::log10(std::max(amplitude, 1e-9))));
  }
  return cut + "]";
}

std::string cosine_table(double step_deg) {
  const std::string cut = cosine_cut(step_deg);
  return "pattern = \"table\"\npattern_azimuth = " + cut + "\npattern_elevation = " + cut + "\n";
}

// Largest difference of the probability of detection between two patterns, all round an antenna.
double worst_difference(const Scene& a, const Scene& b) {
  const mocks::AntennaPattern one = air_of(a).pattern;
  const mocks::AntennaPattern other = air_of(b).pattern;
  double worst = 0.0;
  for (double azimuth = -180.0; azimuth < 180.0; azimuth += 1.7)
    for (double elevation = -88.0; elevation < 90.0; elevation += 1.9)
      for (const double range : {0.3, 1.0, 2.0, 3.5}) {
        const double h = hal::deg_to_rad(azimuth);
        const double v = hal::deg_to_rad(elevation);
        const hal::Vec3 at{range * std::cos(v) * std::cos(h), range * std::cos(v) * std::sin(h),
                           range * std::sin(v)};
        const auto probability = [&](const mocks::AntennaPattern& pattern) {
          return mocks::detection_probability(
              mocks::normalised_range(range, 2.5, pattern.power(at), mocks::kPaperPatternExponent));
        };
        worst = std::max(worst, std::abs(probability(one) - probability(other)));
      }
  return worst;
}

TEST(ScenePattern, ACosineSampledFinelyIsTheCosine) {
  const auto cosine = scene_with("");
  const auto degree = scene_with(cosine_table(1.0));
  const auto tenth = scene_with(cosine_table(0.1));
  ASSERT_TRUE(cosine && degree && tenth);
  // Straight lines between samples: the error falls with the square of the step, most of it beside the nulls.
  const double coarse = worst_difference(*cosine, *degree);
  const double fine = worst_difference(*cosine, *tenth);
  EXPECT_LT(coarse, 1e-2);
  EXPECT_LT(fine, 1e-4);
  EXPECT_LT(fine, 0.1 * coarse);
}

TEST(ScenePattern, ANarrowerBeamHearsFewerTags) {
  Scene scene = test_scene("calibration");
  const auto heard = [&scene] {
    const auto recording = simulate_recording(scene, 1, 48.0);
    EXPECT_TRUE(recording) << describe(recording.error());
    return recording ? recording->reads.size() : 0;
  };
  const std::size_t cosine = heard();
  const Scene formula = test_scene("calibration");
  const auto radio_as_before = [&](const std::string& table) {
    const SceneRadio tabled = scene_with(table)->world.radio;
    scene.world.radio = formula.world.radio;
    scene.world.radio.pattern = tabled.pattern;
    scene.world.radio.pattern_azimuth = tabled.pattern_azimuth;
    scene.world.radio.pattern_elevation = tabled.pattern_elevation;
  };
  radio_as_before(cosine_table(1.0));
  // Other draws, the same expectation: three deviations of the difference of two counts.
  EXPECT_NEAR(static_cast<double>(heard()), static_cast<double>(cosine),
              3.0 * std::sqrt(2.0 * static_cast<double>(cosine)));
  radio_as_before(
      "pattern = \"table\"\npattern_azimuth = [[-20, -30], [0, 0], [20, -30]]\n"
      "pattern_elevation = [[-20, -30], [0, 0], [20, -30]]\n");
  EXPECT_LT(heard(), cosine / 2);
}

TEST(ScenePattern, ABackLobeHearsWhatIsBehind) {
  const auto scene = scene_with(
      "pattern = \"table\"\npattern_azimuth = [[-180, -8], [-90, -25], [0, 0], [90, -25], [180, -8]]\n"
      "pattern_elevation = [[-90, -20], [0, 0], [90, -20]]\n");
  ASSERT_TRUE(scene) << describe(scene.error());
  EXPECT_NEAR(air_of(*scene).pattern.power({-1.0, 0.0, 0.0}), std::pow(10.0, -0.8), 1e-9);
  EXPECT_NEAR(air_of(*scene).pattern.power({1.0, 0.0, 0.0}), 1.0, 1e-12);
}

TEST(ScenePattern, EveryMistakeIsNamed) {
  EXPECT_EQ(complaint("pattern_azimuth = [[-90, -20], [0, 0], [90, -20]]"), "taken");
  EXPECT_THAT(complaint(""), AllOf(HasSubstr("pattern_azimuth"), HasSubstr("is missing")));
  EXPECT_THAT(complaint("pattern_azimuth = [[0, 0]]"), HasSubstr("has 1 samples"));
  EXPECT_THAT(complaint("pattern_azimuth = [[-10, 0], [-10, -3], [10, 0]]"),
              AllOf(HasSubstr("sample 2"), HasSubstr("not above -10"), HasSubstr("Sort")));
  EXPECT_THAT(complaint("pattern_azimuth = [[-10, -3], [0, 0.5], [10, -3]]"),
              AllOf(HasSubstr("sample 2"), HasSubstr("0.5 dB")));
  EXPECT_THAT(complaint("pattern_azimuth = [[-200, -3], [0, 0]]"), HasSubstr("angle -200"));
  EXPECT_THAT(complaint("pattern_azimuth = [[10, 0], [20, -3]]"), HasSubstr("reaches from 10 to 20"));
  EXPECT_THAT(complaint("pattern_azimuth = [[0, 0, 0]]"), HasSubstr("pattern_azimuth"));
  EXPECT_THAT(complaint("pattern_azimuth = [[-10, nan], [10, 0]]"), HasSubstr("pattern_azimuth"));
}

}  // namespace
}  // namespace forager::boards
