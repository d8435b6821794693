#pragma once

#include <cstdint>
#include <memory>

#include "boards/scene.hpp"
#include "flight/policy.hpp"

namespace forager::boards {

// The policy a scene asks for. The seed matters to the random walk only.
[[nodiscard]] std::unique_ptr<flight::Policy> make_policy(const Scene& scene, std::uint64_t seed);

}  // namespace forager::boards
