#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "flight/ground_detour.hpp"
#include "flight/hop_planner.hpp"
#include "flight/hybrid_energy.hpp"
#include "hal/error.hpp"

namespace forager::flight {

// Roll or fly: one leg of a hybrid way.
struct HybridLeg {
  enum class Kind : std::uint8_t { roll, hop };
  Kind kind = Kind::roll;
  std::vector<hal::Vec3> way_world;  // roll: corners, start included; at least two
  Hop hop;                           // hop
};

// How one stretch between two goals was decided.
struct HybridChoice {
  bool hops = false;
  std::string why;         // "the ground is free", "no way round on the ground", "the hop takes less energy"
  EnergyEstimate rolling;  // the way on the ground; zero if there is none
  EnergyEstimate hopping;  // the way with hops; zero if there is none
  bool can_roll = false;
  bool can_hop = false;
};

struct HybridRoute {
  std::vector<HybridLeg> legs;
  std::vector<HybridChoice> choices;  // one for each stretch between goals
  EnergyEstimate estimate;            // of the legs
  [[nodiscard]] std::size_t hops() const;
};

struct HybridRouteConfig {
  HopLimits hop;
  GroundArea area;
  // A hop must save this share of the energy of the way round: it wears and it risks more than rolling.
  double least_saving = 0.2;
};

// From a start past goals over the ground and, where the ground is blocked or the energy estimate says so,
// over obstacles (thesis sec. 6.6.3). Rolls by default. Errors: invalid_argument (fewer than two places, or
// not finite), refused (a stretch that can neither be rolled nor hopped; says which and why).
[[nodiscard]] hal::Result<HybridRoute> plan_route(std::span<const hal::Vec3> places_world, double heading_rad,
                                                  std::span<const HopObstacle> obstacles,
                                                  const HybridRouteConfig& config, const EnergyModel& energy);

}  // namespace forager::flight
