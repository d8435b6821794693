#pragma once

#include <memory>
#include <vector>

#include "boards/scene.hpp"
#include "hal/error.hpp"
#include "mocks/body.hpp"
#include "mocks/gen2_slot_parameters.hpp"
#include "mocks/tag_field.hpp"
#include "mocks/world.hpp"

namespace forager::boards {

// The antennas' pattern. Errors: invalid_argument from a table that is none (a scene file with such a table
// is refused before).
[[nodiscard]] hal::Result<mocks::AntennaPattern> pattern_of(const SceneRadio& radio);
// The air of a scene, and where the read plan's antennas sit on the vehicle: at its centre, looking along
// their bearings.
[[nodiscard]] mocks::AirParameters air_of(const Scene& scene);
[[nodiscard]] mocks::SlotParameters slots_of(const Scene& scene);
[[nodiscard]] std::vector<mocks::AntennaMounting> antennas_of(const Scene& scene);

// Errors: invalid_argument (a link no reader may use, a dwell too short for a read, ...), the file as device.
[[nodiscard]] hal::Result<> check_air(const Scene& scene);
// The air at the level that the scene asks for. The scene must have passed check_air(); world and body must
// outlive the field.
[[nodiscard]] std::unique_ptr<mocks::TagField> make_field(const Scene& scene, const mocks::World& world,
                                                          const mocks::TrueBody& body, std::uint64_t seed);

}  // namespace forager::boards
