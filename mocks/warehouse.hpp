#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hal/error.hpp"
#include "hal/pose.hpp"
#include "hal/random.hpp"
#include "mocks/world.hpp"

namespace forager::mocks {

// Numbers tags as SGTIN-96 (GS1 tag data standard, header 30 hex, filter 1, partition 5): a 24-bit company
// prefix, a 20-bit item reference and a 38-bit serial that counts up. Two sequences with different prefix or
// item never give the same EPC.
class EpcSequence {
 public:
  // Bits beyond 24, 20 and 38 are dropped.
  EpcSequence(std::uint32_t company, std::uint32_t item, std::uint64_t first_serial = 1)
      : company_(company & 0xFFFFFFU), item_(item & 0xFFFFFU), serial_(first_serial) {}
  // 24 lower-case hexadecimal digits.
  [[nodiscard]] std::string next();
  // The same as bytes.
  [[nodiscard]] Epc96 next96();

 private:
  std::uint32_t company_;
  std::uint32_t item_;
  std::uint64_t serial_;
};

// A straight row of shelving: a closed box from the floor up, `depth_m` deep, centred on the line between two
// points of the floor (z is ignored). Errors: invalid_argument (the line does not run along x or y, zero
// length, depth or height not positive).
[[nodiscard]] hal::Result<Box> shelf_row(hal::Vec3 start, hal::Vec3 end, double depth_m, double height_m);

// The same row seen from the aisle: its face runs through the two points and the shelf stands on the left of
// the way from start to end (negative depth: on the right).
[[nodiscard]] hal::Result<Box> shelf_with_face(hal::Vec3 start, hal::Vec3 end, double depth_m,
                                               double height_m);

// A box of tagged goods. Tags scatter evenly within +-half_width in x and y and 0..height above the centre
// (the laboratory's simulator: 0.5 m each).
struct BoxGroup {
  hal::Vec3 centre;
  int tags = 30;
  double half_width_m = 0.5;
  double height_m = 0.5;
  bool wanted = true;
  std::optional<Box> within = {};  // keep the scatter inside this box, evenly, where the two overlap
};

// Adds the tags of a group to the world.
void add_group(World& world, const BoxGroup& group, EpcSequence& epcs, hal::Random& random);

// Adds `count` groups like `first`, each `pitch` from the one before.
void add_groups(World& world, const BoxGroup& first, hal::Vec3 pitch, int count, EpcSequence& epcs,
                hal::Random& random);

}  // namespace forager::mocks
