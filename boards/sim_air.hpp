#pragma once

#include <vector>

#include "boards/scene.hpp"
#include "mocks/gen2_field_parameters.hpp"

namespace forager::boards {

// The air of a scene, and where the read plan's antennas sit on the vehicle: at its centre, looking along
// their bearings.
[[nodiscard]] mocks::AirParameters air_of(const Scene& scene);
[[nodiscard]] std::vector<mocks::AntennaMounting> antennas_of(const Scene& scene);

}  // namespace forager::boards
