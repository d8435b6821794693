#pragma once

#include <cstddef>
#include <cstdint>

#include "boards/board.hpp"
#include "boards/scene.hpp"
#include "flight/mavlink_config.hpp"
#include "flight/robot_loop.hpp"
#include "reader/advannet_reader.hpp"

namespace forager::boards {

// The reader's output with the lamp: active while the robot is armed.
inline constexpr std::uint8_t kLampLine = 1;

// A scene in the terms of the parts that carry it out.
[[nodiscard]] flight::RobotLoopConfig robot_config(const Scene& scene, std::size_t expected_tags);
[[nodiscard]] flight::MavlinkConfig mavlink_config(const Scene& scene, bool journal_wire);
[[nodiscard]] reader::AdvanNetConfig advannet_config(const Scene& scene, const Board& board);

}  // namespace forager::boards
