#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "hal/random.hpp"
#include "hal/units.hpp"
#include "reader/inventory_store.hpp"

namespace forager::test {

// Batch `number` of an endless made-up run: the same number gives the same reads in every process.
inline std::vector<reader::LocatedRead> sample_batch(std::uint64_t number, std::size_t size = 50,
                                                     std::uint64_t tags = 400) {
  hal::Random random = hal::Random::stream(11, number);
  std::vector<reader::LocatedRead> batch(size);
  for (reader::LocatedRead& located : batch) {
    const std::uint64_t tag = random.below(tags);
    std::vector<std::uint8_t> bytes(tag % 7 == 0 ? 8 : 12);
    bytes[0] = 0x30;
    bytes[6] = static_cast<std::uint8_t>(tag >> 8);
    bytes[7] = static_cast<std::uint8_t>(tag);
    located.read.epc = reader::Epc::from_bytes(bytes).value();
    located.read.port = static_cast<std::uint8_t>(1 + random.below(4));
    located.read.rssi_dbm = static_cast<std::int16_t>(-80 + static_cast<int>(random.below(40)));
    located.read.read_count = static_cast<std::uint32_t>(1 + random.below(3));
    located.read.heard = hal::Instant(std::chrono::milliseconds(2000 * number + random.below(3500)));
    located.pose_known = random.chance(0.9);
    if (located.pose_known)
      located.pose_world = {{random.uniform(0, 30), random.uniform(-5, 5), 1.5},
                            random.uniform(-hal::kPi, hal::kPi),
                            0.01,
                            -0.02};
  }
  return batch;
}

inline void expect_same_items(const std::vector<reader::InventoryItem>& a,
                              const std::vector<reader::InventoryItem>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    SCOPED_TRACE(a[i].epc.hex());
    ASSERT_EQ(a[i].epc, b[i].epc);
    ASSERT_EQ(a[i].count, b[i].count);
    ASSERT_EQ(a[i].first_seen, b[i].first_seen);
    ASSERT_EQ(a[i].last_seen, b[i].last_seen);
    ASSERT_EQ(a[i].best_rssi_dbm, b[i].best_rssi_dbm);
    ASSERT_EQ(a[i].best_port, b[i].best_port);
    ASSERT_EQ(a[i].pose_known, b[i].pose_known);
    ASSERT_EQ(a[i].best_pose_world.position, b[i].best_pose_world.position);
    ASSERT_EQ(a[i].best_pose_world.yaw_rad, b[i].best_pose_world.yaw_rad);
    ASSERT_EQ(a[i].best_pose_world.pitch_rad, b[i].best_pose_world.pitch_rad);
    ASSERT_EQ(a[i].best_pose_world.roll_rad, b[i].best_pose_world.roll_rad);
  }
}

}  // namespace forager::test
