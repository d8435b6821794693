#pragma once

#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include "hal/units.hpp"
#include "mocks/gen2_field.hpp"
#include "mocks/store_plan.hpp"
#include "tests/mocks/placed_body.hpp"

namespace forager::mocks {

// A reader with four antennas carried through a world.
struct FieldRig {
  FieldRig() {
    for (int i = 0; i < 4; ++i) {
      const double bearing = 0.5 * hal::kPi * i;
      antennas.push_back({i + 1, hal::rotate_yaw({0.15, 0.0, 0.0}, bearing), hal::wrap_pi(bearing), 0.0});
      settings.ports.push_back({i + 1, 30.0, -200.0});
    }
  }

  // Reads of so many seconds, the body's pose given at each tick by `drive` (seconds -> pose).
  std::vector<AirRead> listen(double seconds, double tick_s, std::uint64_t seed) {
    body.body.pose = drive(0.0);
    SimTagField field(world, body, antennas, air, seed);
    std::vector<AirRead> reads;
    hal::Instant now{};
    field.radio_on(settings, now);
    for (int i = 1; i <= static_cast<int>(std::lround(seconds / tick_s)); ++i) {
      now = hal::Instant{} + hal::from_seconds(i * tick_s);
      body.body.pose = drive(i * tick_s);
      field.advance(now, reads);
    }
    statistics = field.statistics();
    return reads;
  }

  void store(StoreKind kind, std::size_t tags) {
    world = {};
    EpcSequence epcs(1, 1);
    hal::Random random(5);
    static_cast<void>(add_store(world, {.kind = kind, .tags = tags}, epcs, random));
  }

  static std::size_t unique(const std::vector<AirRead>& reads) {
    std::set<std::uint32_t> tags;
    for (const AirRead& read : reads) tags.insert(read.tag);
    return tags.size();
  }

  World world;
  PlacedBody body;
  std::vector<AntennaMounting> antennas;
  AirParameters air;
  RadioSettings settings;
  std::function<hal::Pose(double)> drive = [](double) { return hal::Pose{{0.0, 0.0, 1.2}}; };
  FieldStatistics statistics;
};

// Two ways to do one thing, tried with many seeds: their totals, and how far apart they are in standard
// errors of the difference.
class Compared {
 public:
  void add(double one, double other) {
    ++count_;
    sum_ += one + other;
    const double d = other - one;
    const double before = d - mean_;
    mean_ += before / count_;
    squares_ += before * (d - mean_);
  }
  // Of the difference, as a share of the total.
  [[nodiscard]] double error() const {
    return std::sqrt(squares_ / (count_ - 1.0) / count_) / (0.5 * sum_ / count_);
  }
  [[nodiscard]] double difference() const { return mean_ / (0.5 * sum_ / count_); }
  [[nodiscard]] double deviations() const { return std::abs(difference()) / error(); }

 private:
  double count_ = 0.0;
  double sum_ = 0.0;
  double mean_ = 0.0;
  double squares_ = 0.0;
};

}  // namespace forager::mocks
