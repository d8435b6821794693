#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mocks/gen2_field_flags.hpp"
#include "mocks/gen2_field_link.hpp"
#include "mocks/tag_grid.hpp"
#include "mocks/world.hpp"

namespace forager::mocks {

// What one antenna could hear: stretches of the line on which the bounds of all candidates lie end to end.
struct Audible {
  struct Stretch {
    double from_per_s = 0.0;
    double to_per_s = 0.0;
  };
  std::array<Stretch, 17> stretches{};
  std::size_t count = 0;
  double total_per_s = 0.0;
};

// The tags a reader could hear from about one place, each with an upper bound of its hazard rate that holds
// for any attitude, so that replies can be drawn by thinning. Bounds are never below the true rate: leaving
// tags out here changes no probability.
//
// The tags of the world lie in grids by sensitivity, so that the many deaf ones are looked for nearby only;
// the candidates lie by compass sector, so that an antenna can leave out what is behind it.
class NearbyTags {
 public:
  struct Candidate {
    std::uint32_t tag;
    double bound_per_s;
    double sum_per_s;  // of all bounds up to and with this one
  };
  // The antennas are within slack_m (and the length of their arms) of `centre`; none has a reach above this.
  struct Place {
    hal::Vec3 centre;
    double slack_m = 0.0;
    double max_reach = 1.0;
  };
  // Tags that answer neither now nor at until_s, in a session that keeps them silent in between, may be left
  // out.
  struct Silence {
    const SessionFlags* flags = nullptr;
    int session = 0;
    char target = 'A';
    std::uint64_t dwell = 0;
    double now_s = 0.0;
    double until_s = 0.0;
  };

  // Keeps references to world and link. Tags at no finite place are heard by nobody.
  NearbyTags(const World& world, const AirLink& link, const AirParameters& air);

  // Looks around anew. silence may be null.
  void renew(const Place& place, const Silence* silence);

  [[nodiscard]] std::span<const Candidate> all() const { return candidates_; }
  [[nodiscard]] double sum_per_s() const { return candidates_.empty() ? 0.0 : candidates_.back().sum_per_s; }
  // Tags left out by the last renew() because they are silent.
  [[nodiscard]] std::size_t silent() const { return silent_; }
  // Grows by one with each renew().
  [[nodiscard]] std::uint64_t generation() const { return generation_; }
  // Tags the last renew() computed a distance to.
  [[nodiscard]] std::size_t examined() const { return examined_; }

  // Every candidate.
  [[nodiscard]] Audible everything() const;
  // Everything but sectors in which no tag can be before the antenna, as long as it turns by less than
  // turn_rad and stays within the place last given.
  [[nodiscard]] Audible before(const AntennaView& antenna, double turn_rad) const;
  // One of them in proportion to its bound; share: uniform in [0, 1). The total must be above 0.
  [[nodiscard]] const Candidate& pick(const Audible& audible, double share) const;

  // Calls visit(tag) at least for every tag that could get power at the place.
  template <class Visit>
  void within_power(const Place& place, Visit&& visit) const {
    for (const Layer& layer : layers_)
      each_run(layer, place, [&](const TagGrid::Run& run) {
        for (std::size_t slot = run.first; slot < run.last; ++slot) visit(layer.grid.id()[slot]);
      });
  }

 private:
  struct Layer {
    TagGrid grid;
    std::vector<double> per_r0;  // 1/R0, by slot
    double max_r0_m = 0.0;
  };
  static constexpr std::size_t kSectors = 16;
  static constexpr std::size_t kAround = kSectors;  // too near for a direction
  struct Sector {
    double nearest_m = 0.0;  // in plan
    double highest_m = 0.0;  // above or below
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };
  struct Found {
    std::uint32_t tag;
    std::uint32_t sector;
    double bound_per_s;
  };

  template <class Visit>
  void each_run(const Layer& layer, const Place& place, Visit&& visit) const {
    if (use_grid_)
      layer.grid.visit(place.centre, radius_of(layer, place), visit);
    else if (layer.grid.size() > 0)
      visit(TagGrid::Run{0, layer.grid.size(), false});
  }
  [[nodiscard]] double radius_of(const Layer& layer, const Place& place) const;
  void build_layers(const World& world, double spread_db);
  void look(const Layer& layer, const Place& place, const Silence* silence);
  void sort_by_sector();
  [[nodiscard]] bool hidden(const Sector& sector, std::size_t number, hal::Vec3 normal,
                            double turn_rad) const;

  const AirLink* link_;
  AntennaPattern pattern_;
  bool use_grid_;
  std::vector<Layer> layers_;
  Place place_;
  double margin_m_ = 0.0;  // slack and arm
  std::vector<Found> found_;
  std::vector<Candidate> candidates_;  // sector after sector
  std::array<Sector, kSectors + 1> sectors_{};
  std::vector<std::uint32_t> guide_;  // [k]: candidate at share k/size of the line
  std::size_t silent_ = 0;
  std::size_t examined_ = 0;
  std::uint64_t generation_ = 0;
};

}  // namespace forager::mocks
