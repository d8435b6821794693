#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "mocks/gen2_field.hpp"
#include "mocks/warehouse.hpp"
#include "tests/mocks/placed_body.hpp"

namespace forager::mocks {

// A round-level field with tags laid out by hand, one antenna unless a test asks for four.
class SimTagFieldTest : public testing::Test {
 protected:
  SimTagFieldTest() {
    body_.body.pose.position = {0.0, 0.0, 1.2};
    settings_.ports = {{4, 30.0, -200.0}};
    antennas_ = {{4, {}, 0.0, 0.0}};
  }

  // Identical tags, no fade, a reader that loses no time: what remains is the detection model.
  void bare_physics() {
    air_.spread_db = 0.0;
    air_.rician_k_db = FrozenFade::kNoFade_db;
    air_.singulation_s = air_.settle_s = air_.round_s = 0.0;
    air_.t0_s = 1.0;
    air_.r0_m = 2.0;
  }

  void four_antennas() {
    antennas_ = {{4, {0.15, 0.0, 0.0}, 0.0, 0.0},
                 {3, {0.0, 0.15, 0.0}, hal::kPi / 2.0, 0.0},
                 {1, {-0.15, 0.0, 0.0}, hal::kPi, 0.0},
                 {2, {0.0, -0.15, 0.0}, -hal::kPi / 2.0, 0.0}};
    settings_.ports = {{4, 30.0, -80.0}, {3, 30.0, -80.0}, {1, 30.0, -80.0}, {2, 30.0, -80.0}};
  }

  // An aisle 15 m long with 11 boxes of 30 tags on each side.
  void aisle() {
    four_antennas();
    EpcSequence epcs(1, 1);
    hal::Random random(5);
    for (const double side : {1.75, -1.75})
      add_groups(world_, {.centre = {0.7, side, 1.0}, .tags = 30}, {1.36, 0.0, 0.0}, 11, epcs, random);
  }

  void tags_at(hal::Vec3 relative, int count) {
    for (int i = 0; i < count; ++i)
      world_.tags.push_back({std::to_string(world_.tags.size()), body_.body.pose.position + relative});
  }

  std::vector<AirRead> listen(SimTagField& field, double seconds, double tick = 0.02) {
    std::vector<AirRead> reads;
    const hal::Instant start = now_;
    field.radio_on(settings_, now_);
    for (int i = 1; i <= static_cast<int>(std::lround(seconds / tick)); ++i) {
      now_ = start + hal::from_seconds(i * tick);
      if (drive_) drive_(hal::to_seconds(now_ - start));
      field.advance(now_, reads);
    }
    return reads;
  }
  std::vector<AirRead> listen(double seconds, double tick = 0.02, std::uint64_t seed = 9) {
    EXPECT_TRUE(validate(air_, antennas_));
    now_ = hal::Instant{};
    SimTagField field(world_, body_, antennas_, air_, seed);
    return listen(field, seconds, tick);
  }

  static std::size_t unique(const std::vector<AirRead>& reads) {
    std::set<std::uint32_t> tags;
    for (const AirRead& r : reads) tags.insert(r.tag);
    return tags.size();
  }

  World world_;
  PlacedBody body_;
  std::vector<AntennaMounting> antennas_;
  AirParameters air_;
  RadioSettings settings_;
  hal::Instant now_{};
  std::function<void(double)> drive_;
};

}  // namespace forager::mocks
