#include "flight/hybrid_route.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace forager::flight {
namespace {

struct Stretch {
  std::vector<HybridLeg> legs;
  HybridChoice choice;
};

// Legs of the straight way with its hops, and what they cost.
struct HopWay {
  std::vector<HybridLeg> legs;
  EnergyEstimate cost;
};
HopWay way_with_hops(hal::Vec3 from, hal::Vec3 to, double heading_rad, const HopPlan& plan,
                     const EnergyModel& energy) {
  HopWay way;
  const auto roll = [&](hal::Vec3 a, hal::Vec3 b) {
    if (hal::distance_xy(a, b) <= 0.0) return;
    way.legs.push_back({HybridLeg::Kind::roll, {a, b}, {}});
    way.cost = way.cost + energy.roll_along({a, b}, heading_rad);
    heading_rad = std::atan2(b.y - a.y, b.x - a.x);
  };
  for (const Hop& hop : plan.hops) {
    roll(from, hop.takeoff_world);
    way.legs.push_back({HybridLeg::Kind::hop, {}, hop});
    way.cost = way.cost + energy.hop(hop);
    from = hop.landing_world;
    heading_rad = hop.yaw_rad;
  }
  roll(from, to);
  return way;
}

std::string saving(const HybridChoice& choice) {
  return fmt::format("about {:.0f} J over it, {:.0f} J round it", choice.hopping.energy_j,
                     choice.rolling.energy_j);
}

class Planner {
 public:
  Planner(std::span<const HopObstacle> obstacles, const HybridRouteConfig& config, const EnergyModel& energy)
      : obstacles_(obstacles), config_(config), energy_(energy) {}

  hal::Result<Stretch> stretch(hal::Vec3 from, hal::Vec3 to, double heading_rad) const {
    const double half_width = config_.hop.body_radius_m + config_.hop.side_margin_m;
    const HopPlan plan = plan_hops(from, to, obstacles_, config_.hop);
    const auto ground = plan.reason == HopReason::free
                            ? std::optional(std::vector{from, to})
                            : ground_detour(from, to, obstacles_, half_width, config_.area);
    Stretch made;
    HybridChoice& choice = made.choice;
    choice.can_roll = ground.has_value();
    choice.can_hop = plan.reason == HopReason::hop;
    if (ground) choice.rolling = energy_.roll_along(*ground, heading_rad);
    HopWay over;
    if (choice.can_hop) over = way_with_hops(from, to, heading_rad, plan, energy_);
    choice.hopping = over.cost;
    if (!choice.can_roll && !choice.can_hop) return impassable(from, to, plan);
    decide(choice, ground ? ground->size() : 0);
    if (choice.hops)
      made.legs = std::move(over.legs);
    else
      made.legs.push_back({HybridLeg::Kind::roll, *ground, {}});
    return made;
  }

 private:
  void decide(HybridChoice& choice, std::size_t corners) const {
    if (!choice.can_roll) {
      choice.hops = true;
      choice.why = "no way round on the ground";
      return;
    }
    if (corners <= 2) {
      choice.why = "the ground is free";
      return;
    }
    if (!choice.can_hop) {
      choice.why = "no hop over it is possible";
      return;
    }
    choice.hops = choice.hopping.energy_j <= (1.0 - config_.least_saving) * choice.rolling.energy_j;
    choice.why = (choice.hops ? "the hop takes less energy: "
                              : "rolling round it takes less energy, or "
                                "not enough more: ") +
                 saving(choice);
  }
  static hal::Failure impassable(hal::Vec3 from, hal::Vec3 to, const HopPlan& plan) {
    return hal::fail(hal::ErrorCode::refused, "hybrid way",
                     fmt::format("from ({:.2f}, {:.2f}) to ({:.2f}, {:.2f})", from.x, from.y, to.x, to.y),
                     fmt::format("no way on the ground, and no hop ({}{}{})", to_string(plan.reason),
                                 plan.detail.empty() ? "" : ": ", plan.detail),
                     "move the goal, or give the height of what stands in the way");
  }

  std::span<const HopObstacle> obstacles_;
  const HybridRouteConfig& config_;
  const EnergyModel& energy_;
};

// The heading a leg ends with.
double heading_after(const HybridLeg& leg, double before) {
  if (leg.kind == HybridLeg::Kind::hop) return leg.hop.yaw_rad;
  const hal::Vec3 last = leg.way_world.back() - leg.way_world[leg.way_world.size() - 2];
  return last == hal::Vec3{} ? before : std::atan2(last.y, last.x);
}

}  // namespace

std::size_t HybridRoute::hops() const {
  return static_cast<std::size_t>(std::count_if(
      legs.begin(), legs.end(), [](const HybridLeg& leg) { return leg.kind == HybridLeg::Kind::hop; }));
}

hal::Result<HybridRoute> plan_route(std::span<const hal::Vec3> places_world, double heading_rad,
                                    std::span<const HopObstacle> obstacles, const HybridRouteConfig& config,
                                    const EnergyModel& energy) {
  const bool usable = places_world.size() >= 2 && std::isfinite(heading_rad) &&
                      std::all_of(places_world.begin(), places_world.end(), hal::is_finite);
  if (!usable)
    return hal::fail(hal::ErrorCode::invalid_argument, "hybrid way", "plan",
                     "it needs two places or more, all of them finite");
  const Planner planner(obstacles, config, energy);
  HybridRoute route;
  for (std::size_t i = 1; i < places_world.size(); ++i) {
    if (!(hal::distance_xy(places_world[i - 1], places_world[i]) > 0.0)) continue;
    auto stretch = planner.stretch(places_world[i - 1], places_world[i], heading_rad);
    if (!stretch) return hal::fail(std::move(stretch).error());
    route.estimate =
        route.estimate + (stretch->choice.hops ? stretch->choice.hopping : stretch->choice.rolling);
    for (HybridLeg& leg : stretch->legs) {
      heading_rad = heading_after(leg, heading_rad);
      route.legs.push_back(std::move(leg));
    }
    route.choices.push_back(std::move(stretch->choice));
  }
  return route;
}

}  // namespace forager::flight
