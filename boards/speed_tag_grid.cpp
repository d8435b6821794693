#include <algorithm>
#include <cmath>
#include <memory>

#include "boards/radius_peer.hpp"
#include "boards/speed_contest.hpp"
#include "hal/random.hpp"
#include "mocks/tag_grid.hpp"

namespace forager::boards {
namespace {

constexpr std::size_t kTags = 1'000'000;
constexpr double kTagsPerSquareMetre = 25.0;
constexpr double kRadius_m = 6.0;
constexpr std::size_t kQueries = 64;
const char* const kName = "tags within 6 m of 1e6";

// Tags scattered evenly over a square store, heights up to 2 m, and places to ask from.
struct Contest {
  std::vector<double> x, y, z;
  std::vector<hal::Vec3> places;
  mocks::TagGrid grid;
  std::unique_ptr<RadiusPeer> peer;
  std::vector<std::uint32_t> ours_found, other_found;

  Contest() {
    hal::Random random(11);
    const double side = std::sqrt(kTags / kTagsPerSquareMetre);
    for (std::size_t i = 0; i < kTags; ++i) {
      x.push_back(random.uniform(0.0, side));
      y.push_back(random.uniform(0.0, side));
      z.push_back(random.uniform(0.0, 2.0));
    }
    for (std::size_t i = 0; i < kQueries; ++i) {
      const double at_x = random.uniform(0.0, side);
      places.push_back({at_x, random.uniform(0.0, side), 1.2});
    }
    const mocks::PointSpans points{x, y, z};
    if (auto built = mocks::TagGrid::build(points)) grid = *std::move(built);
    peer = make_radius_peer(points);
  }
  void ask_grid(hal::Vec3 place) {
    ours_found.clear();
    grid.within(place, kRadius_m, ours_found);
    keep_result(ours_found.data());
  }
  void ask_peer(hal::Vec3 place) {
    peer->within(place, kRadius_m, other_found);
    keep_result(other_found.data());
  }
  bool agree() {
    return std::all_of(places.begin(), places.end(), [this](hal::Vec3 place) {
      ask_grid(place);
      ask_peer(place);
      std::sort(ours_found.begin(), ours_found.end());
      std::sort(other_found.begin(), other_found.end());
      return !ours_found.empty() && ours_found == other_found;
    });
  }
};

}  // namespace

std::vector<SpeedContest> speed_tag_grid() {
  const auto contest = std::make_shared<Contest>();
  const auto every_place = [contest](void (Contest::*ask)(hal::Vec3)) {
    for (const hal::Vec3 place : contest->places) ((*contest).*ask)(place);
  };
  return {{.name = kName,
           .unit = "queries/s",
           .peer = contest->peer->name(),
           .items = kQueries,
           .ours = [every_place] { every_place(&Contest::ask_grid); },
           .other = [every_place] { every_place(&Contest::ask_peer); },
           .agree = [contest] { return contest->agree(); }}};
}

}  // namespace forager::boards
