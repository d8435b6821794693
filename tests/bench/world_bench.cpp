// Cost of the simulated world per second of mission: the air, the depth camera, the detection formula.
#include <benchmark/benchmark.h>

#include <cmath>

#include "mocks/detection.hpp"
#include "mocks/gen2_field.hpp"
#include "mocks/ray_cast_depth.hpp"
#include "mocks/sim_pose_source.hpp"
#include "mocks/warehouse.hpp"

namespace {

using namespace forager;
using namespace forager::mocks;

struct DrivenBody final : TrueBody {
  BodyState body;
  [[nodiscard]] const BodyState& state() const override { return body; }
};

// An aisle 15 m long, 11 groups a side.
World aisle(int tags_per_group) {
  World world;
  EpcSequence epcs(1, 1);
  hal::Random random(5);
  for (const double side : {1.75, -1.75}) {
    add_groups(world, {.centre = {0.7, side, 1.0}, .tags = tags_per_group}, {1.36, 0.0, 0.0}, 11, epcs,
               random);
    for (int i = 0; i < 10; ++i)
      world.obstacles.push_back({{1.5 * i, side > 0.0 ? side : side - 1.0, 0.0},
                                 {1.5 * i + 1.4, side > 0.0 ? side + 1.0 : side, 2.0}});
  }
  return world;
}

// Ten seconds at 0.5 m/s and 50 Hz per iteration, up and down the aisle.
void tag_field(benchmark::State& state) {
  const World world = aisle(static_cast<int>(state.range(0)) / 22);
  DrivenBody body;
  body.body.pose.position = {0.0, 0.0, 1.2};
  RadioSettings settings;
  std::vector<AntennaMounting> antennas;
  for (int i = 0; i < 4; ++i) {
    const double bearing = 0.5 * hal::kPi * i;
    antennas.push_back({i + 1, hal::rotate_yaw({0.15, 0.0, 0.0}, bearing), bearing, 0.0});
    settings.ports.push_back({i + 1, 30.0, -80.0});
  }
  SimTagField field(world, body, antennas, AirParameters{}, 1);
  std::vector<AirRead> reads;
  hal::Instant now{};
  field.radio_on(settings, now);
  std::size_t heard = 0;
  for (auto _ : state) {
    for (int i = 0; i < 500; ++i) {
      now += std::chrono::milliseconds(20);
      body.body.pose.position.x = 7.5 + 7.5 * std::sin(0.5 / 7.5 * hal::to_seconds(now));
      reads.clear();
      field.advance(now, reads);
      heard += reads.size();
    }
  }
  const double seconds = 10.0 * static_cast<double>(state.iterations());
  state.counters["reads_per_s"] = static_cast<double>(heard) / seconds;
  state.counters["us_per_s"] =
      benchmark::Counter(seconds * 1e-6, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(tag_field)->Arg(330)->Arg(660)->Arg(990)->Unit(benchmark::kMillisecond);

void depth_frame(benchmark::State& state) {
  const World world = aisle(0);
  DrivenBody body;
  body.body.pose.position = {2.0, 0.1, 1.2};
  body.body.pose.pitch_rad = 0.05;
  SimDepthOptions options;
  options.noise_per_m = state.range(0) != 0 ? 0.002 : 0.0;
  SimDepthCamera camera(world, body, options, 1);
  hal::Instant now{};
  for (auto _ : state) {
    now += options.period;
    body.body.pose.yaw_rad += 0.01;
    benchmark::DoNotOptimize(camera.poll(now));
  }
}
BENCHMARK(depth_frame)->ArgName("noise")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

void pose_sample(benchmark::State& state) {
  DrivenBody body;
  SimPoseSource source(body, SimPoseOptions{}, 1);
  hal::Instant now{};
  for (auto _ : state) {
    now += std::chrono::milliseconds(34);
    benchmark::DoNotOptimize(source.poll(now));
  }
}
BENCHMARK(pose_sample);

void detection(benchmark::State& state) {
  const AntennaPattern pattern;
  double y = -2.0;
  for (auto _ : state) {
    y = y > 2.0 ? -2.0 : y + 0.001;
    const double range = std::sqrt(4.09 + y * y);
    benchmark::DoNotOptimize(expected_answers(normalised_range(range, 2.4, pattern.power({2.0, y, 0.3}))));
  }
}
BENCHMARK(detection);

}  // namespace
