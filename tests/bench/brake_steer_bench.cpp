// What a step of the steering controller and one of the emulated vehicle cost.
#include <benchmark/benchmark.h>

#include <vector>

#include "mocks/rolling_vehicle.hpp"
#include "mocks/sim_pose_source.hpp"
#include "servo/brake_steer.hpp"

namespace {

using namespace forager;
using namespace std::chrono_literals;

void steer_step(benchmark::State& state) {
  const std::vector<servo::SteerStep> steps{{0.6, 0.0}, {1.2, 0.2}, {1.8, 0.6}, {2.4, 0.6}, {3.0, 0.6}};
  // One drive is recorded, then only the controller is run on what it saw.
  std::vector<servo::SteerInput> inputs;
  {
    mocks::RollingVehicle vehicle{mocks::RollingParameters{}};
    mocks::SimPoseSource camera(vehicle, {}, 3);
    servo::BrakeSteer steer{servo::BrakeSteerConfig{}};
    if (!steer.begin(steps, 0.0, hal::Instant{})) return;
    for (hal::Instant now{}; now < hal::Instant{120s} && !steer.done(); now += 10ms) {
      vehicle.update(now);
      servo::SteerInput input;
      if (const auto sample = camera.poll(now); sample && *sample) input.pose = *sample;
      input.yaw_rate_rad_s = vehicle.state().yaw_rate_rad_s;
      inputs.push_back(input);
      steer.renew(now + 100ms);
      const servo::SteerOutput out = steer.update(input, now);
      vehicle.command({out.thrust, out.pitch_rad, out.brakes.left, out.brakes.right});
    }
  }
  std::int64_t count = 0;
  for (auto _ : state) {
    servo::BrakeSteer steer{servo::BrakeSteerConfig{}};
    if (!steer.begin(steps, 0.0, hal::Instant{})) return;
    hal::Instant now{};
    for (const servo::SteerInput& input : inputs) {
      steer.renew(now + 100ms);
      benchmark::DoNotOptimize(steer.update(input, now));
      now += 10ms;
      ++count;
    }
  }
  state.SetItemsProcessed(count);
  state.counters["a_step"] = benchmark::Counter(static_cast<double>(count),
                                                benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(steer_step)->Unit(benchmark::kMillisecond);

void vehicle_step(benchmark::State& state) {
  mocks::RollingVehicle vehicle{mocks::RollingParameters{}};
  vehicle.command({.thrust = 0.15, .pitch_rad = 0.4, .brake_left = 1.0, .brake_right = 0.0});
  for (auto _ : state) {
    vehicle.step();
    benchmark::DoNotOptimize(vehicle.state());
  }
}
BENCHMARK(vehicle_step);

}  // namespace
