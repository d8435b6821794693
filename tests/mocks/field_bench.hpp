#pragma once

#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include "mocks/gen2_field_parameters.hpp"
#include "mocks/tag_field.hpp"
#include "mocks/warehouse.hpp"
#include "mocks/world.hpp"
#include "tests/mocks/placed_body.hpp"

namespace forager::mocks {

// A reader at rest 1.2 m above the floor with one antenna forward on port 1, and a world without tags.
struct FieldBench {
  FieldBench() {
    body.body.pose.position = {0.0, 0.0, 1.2};
    settings.ports = {{1, 30.0, -200.0}};
  }

  // Identical tags, no fade, no dead time: what remains is the detection model.
  void bare_physics() {
    air.spread_db = 0.0;
    air.rician_k_db = 100.0;
    air.settle_s = 0.0;
    air.t0_s = 1.0;
    air.r0_m = 2.0;
  }
  void four_ports() {
    antennas = {
        {1, {}, 0.0, 0.0}, {2, {}, hal::kPi / 2, 0.0}, {3, {}, hal::kPi, 0.0}, {4, {}, -hal::kPi / 2, 0.0}};
    settings.ports = {{1, 30.0, -200.0}, {2, 30.0, -200.0}, {3, 30.0, -200.0}, {4, 30.0, -200.0}};
  }
  void tags_at(hal::Vec3 relative, int count) {
    for (int i = 0; i < count; ++i)
      world.tags.push_back({epcs.next(), body.body.pose.position + relative, true});
  }
  // In the beam, 0.8 to 2.5 m ahead.
  void tags_in_view(int count) {
    hal::Random random(1);
    for (int i = 0; i < count; ++i)
      tags_at({random.uniform(0.8, 2.5), random.uniform(-0.8, 0.8), random.uniform(-0.5, 0.5)}, 1);
  }
  std::vector<AirRead> listen(TagField& field, double seconds, double tick = 0.1) {
    std::vector<AirRead> reads;
    const hal::Instant start = now;
    field.radio_on(settings, now);
    for (int i = 1; i <= static_cast<int>(std::lround(seconds / tick)); ++i) {
      now = start + hal::from_seconds(i * tick);
      if (drive) drive(hal::to_seconds(now - start));
      field.advance(now, reads);
    }
    return reads;
  }
  static std::size_t unique(const std::vector<AirRead>& reads, double until_s = 1e18) {
    std::set<std::uint32_t> tags;
    for (const AirRead& r : reads)
      if (hal::to_seconds(r.at) <= until_s) tags.insert(r.tag);
    return tags.size();
  }

  World world;
  PlacedBody body;
  std::vector<AntennaMounting> antennas{{1, {}, 0.0, 0.0}};
  AirParameters air;
  RadioSettings settings;
  EpcSequence epcs{1, 1};
  hal::Instant now{};
  std::function<void(double)> drive;
};

}  // namespace forager::mocks
