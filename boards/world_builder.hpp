#pragma once

#include "boards/device_set.hpp"
#include "boards/scene.hpp"
#include "mocks/ray_cast_depth.hpp"
#include "mocks/sim_autopilot_config.hpp"
#include "mocks/sim_pose_source.hpp"
#include "mocks/tag_layout.hpp"
#include "mocks/world.hpp"

namespace forager::boards {

// The simulated warehouse of a scene. The same scene and seed give the same tags in the same places.
[[nodiscard]] mocks::World build_world(const Scene& scene, std::uint64_t seed);
// The list that the scene keeps of its tags, wrong as its `mislabeled` and `unlisted` say. The same scene and
// seed give the same list.
[[nodiscard]] mocks::TagLayout build_layout(const Scene& scene, const mocks::World& world,
                                            std::uint64_t seed);
// The world must outlive what it gives.
[[nodiscard]] WorldFacts facts_of(const Scene& scene, const mocks::World& world, std::uint64_t seed);

[[nodiscard]] mocks::SimDepthOptions depth_options(const Scene& scene);
[[nodiscard]] mocks::SimPoseOptions pose_options(const Scene& scene);
[[nodiscard]] mocks::SimAutopilotConfig autopilot_config(const Scene& scene, std::uint64_t seed);

// Streams of randomness, so that a change in one part leaves the numbers of the others alone.
enum class SeedStream : std::uint64_t { tags = 1, air, camera, pose, autopilot, reader, policy, layout };
[[nodiscard]] std::uint64_t seed_for(std::uint64_t seed, SeedStream stream);

}  // namespace forager::boards
