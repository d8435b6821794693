#pragma once

#include <cstdint>
#include <memory>

#include "boards/board.hpp"
#include "boards/scene.hpp"
#include "hal/depth_source.hpp"
#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::boards {

// The depth camera of a board, with what it needs to live.
class DepthBench {
 public:
  virtual ~DepthBench() = default;
  [[nodiscard]] virtual hal::DepthSource& camera() = 0;
  virtual void advance(hal::Instant now) = 0;
};

// An emulated camera in the scene's warehouse, as boards have no other yet: on a board of kind sim it looks
// from the scene's start at flown height, on one of kind socket from where the emulated autopilot says the
// vehicle is (and at the start until then). Errors: busy (the truth feed's port is in use), not_present, io.
[[nodiscard]] hal::Result<std::unique_ptr<DepthBench>> open_depth_bench(const Board& board,
                                                                        const Scene& scene,
                                                                        std::uint64_t seed);

}  // namespace forager::boards
