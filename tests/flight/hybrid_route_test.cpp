#include "flight/hybrid_route.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace forager::flight {
namespace {

Hop hop_of(double climb, double length) {
  Hop hop;
  hop.climb_m = climb;
  hop.length_m = length;
  hop.landing_world = {length, 0.0, 0.0};
  return hop;
}

TEST(EnergyModel, HoverPowerIsThatOfMomentumTheory) {
  EnergyAssumptions a;
  a.figure_of_merit = 1.0;
  a.drive_efficiency = 1.0;
  const EnergyModel ideal(a);
  // 34.3 N on 0.2027 m2: induced velocity sqrt(T / 2 rho A) = 8.40 m/s, so 288 W.
  const double thrust = 3.5 * 9.80665;
  const double area = 4.0 * 3.14159265358979 * 0.127 * 0.127;
  EXPECT_NEAR(ideal.thrust_power_w(thrust), thrust * std::sqrt(thrust / (2.0 * 1.2 * area)), 1e-9);
  EXPECT_NEAR(ideal.thrust_power_w(thrust), 288.0, 1.0);
  EXPECT_NEAR(EnergyModel({}).thrust_power_w(thrust), 288.0 / 0.45, 3.0);
}

TEST(EnergyModel, RollingAMetreTakesFarLessThanFlyingIt) {
  const EnergyModel model({});
  const double rolled = model.roll(2.0).energy_j - model.roll(1.0).energy_j;
  const double flown = model.hop(hop_of(0.7, 2.0)).energy_j - model.hop(hop_of(0.7, 1.0)).energy_j;
  EXPECT_GT(flown, 5.0 * rolled);
  EXPECT_GT(model.rolled_instead_m(hop_of(0.7, 2.2)), 2.2) << "a hop never pays on free ground";
}

TEST(EnergyModel, GrowsWithEverythingThatCosts) {
  const EnergyModel model({});
  EXPECT_GT(model.hop(hop_of(1.0, 2.0)).energy_j, model.hop(hop_of(0.5, 2.0)).energy_j);
  EXPECT_GT(model.hop(hop_of(1.0, 3.0)).time_s, model.hop(hop_of(1.0, 2.0)).time_s);
  EXPECT_GT(model.roll(3.0).energy_j, model.roll(2.0).energy_j);
  EXPECT_GT(model.turn(1.0).energy_j, model.turn(0.5).energy_j);
  EXPECT_EQ(model.turn(-1.0).energy_j, model.turn(1.0).energy_j);
  EnergyAssumptions heavy;
  heavy.mass_kg = 7.0;
  EXPECT_NEAR(EnergyModel(heavy).thrust_power_w(7.0), model.thrust_power_w(7.0), 1e-12);
  EXPECT_GT(EnergyModel(heavy).hop(hop_of(1.0, 2.0)).energy_j, 2.5 * model.hop(hop_of(1.0, 2.0)).energy_j)
      << "power grows with the mass to the power of 1.5";
}

TEST(EnergyModel, SaysWhatItAssumes) {
  const auto lines = EnergyModel({}).assumptions();
  std::string all;
  for (const auto& line : lines) all += line + "\n";
  for (const char* part :
       {"nothing of it was measured", "3.50 kg", "figure of merit 0.60", "0.025", "12.0 W"})
    EXPECT_NE(all.find(part), std::string::npos) << part;
}

TEST(EnergyModel, RefusesAVehicleThatCannotRoll) {
  const auto with = [](auto change) {
    EnergyAssumptions a;
    change(a);
    return static_cast<bool>(validate(a));
  };
  EXPECT_TRUE(with([](EnergyAssumptions&) {}));
  EXPECT_FALSE(with([](EnergyAssumptions& a) { a.rolling_thrust_n = 1.0; })) << "drag holds it";
  EXPECT_FALSE(with([](EnergyAssumptions& a) { a.rolling_thrust_n = 60.0; })) << "it lifts off";
  EXPECT_FALSE(with([](EnergyAssumptions& a) { a.mass_kg = std::nan(""); }));
  EXPECT_FALSE(with([](EnergyAssumptions& a) { a.figure_of_merit = 0.0; }));
  EXPECT_FALSE(with([](EnergyAssumptions& a) { a.stop_s = -1.0; }));
  EXPECT_FALSE(with([](EnergyAssumptions& a) { a.rotors = 0; }));
}

class HybridRouteTest : public ::testing::Test {
 protected:
  hal::Result<HybridRoute> plan(std::vector<hal::Vec3> places) {
    return plan_route(places, 0.0, obstacles, config, EnergyModel(assumptions));
  }
  static HopObstacle wall(double x, double y, double half_length, double height) {
    return {{x, y, 0.0}, 0.1, half_length, 0.0, height};
  }
  std::vector<HopObstacle> obstacles;
  HybridRouteConfig config;
  EnergyAssumptions assumptions;
};

TEST_F(HybridRouteTest, RollsByDefault) {
  const auto route = plan({{}, {3.0, 0.0, 0.0}, {3.0, 4.0, 0.0}});
  ASSERT_TRUE(route);
  ASSERT_EQ(route->legs.size(), 2U);
  EXPECT_EQ(route->hops(), 0U);
  EXPECT_EQ(route->choices[0].why, "the ground is free");
  EXPECT_GT(route->estimate.energy_j, 0.0);
}

TEST_F(HybridRouteTest, RollsRoundWhatIsSmall) {
  obstacles.push_back(wall(4.0, 0.0, 0.3, 0.3));
  const auto route = plan({{}, {8.0, 0.0, 0.0}});
  ASSERT_TRUE(route);
  EXPECT_EQ(route->hops(), 0U) << route->choices[0].why;
  EXPECT_TRUE(route->choices[0].can_hop);
  EXPECT_LT(route->choices[0].rolling.energy_j, route->choices[0].hopping.energy_j);
}

TEST_F(HybridRouteTest, HopsWhereTheGroundIsClosed) {
  config.area = {-1.0, -1.5, 10.0, 1.5};
  obstacles.push_back(wall(4.0, 0.0, 2.0, 0.3));
  const auto route = plan({{}, {8.0, 0.0, 0.0}});
  ASSERT_TRUE(route) << hal::describe(route.error());
  ASSERT_EQ(route->legs.size(), 3U);
  EXPECT_EQ(route->legs[1].kind, HybridLeg::Kind::hop);
  EXPECT_EQ(route->choices[0].why, "no way round on the ground");
  EXPECT_EQ(route->legs[0].way_world.back(), route->legs[1].hop.takeoff_world);
  EXPECT_EQ(route->legs[2].way_world.front(), route->legs[1].hop.landing_world);
}

TEST_F(HybridRouteTest, HopsWhereTheWayRoundTakesMoreEnergy) {
  obstacles.push_back(wall(4.0, 0.0, 200.0, 0.3));
  const auto route = plan({{}, {8.0, 0.0, 0.0}});
  ASSERT_TRUE(route);
  EXPECT_EQ(route->hops(), 1U) << route->choices[0].why;
  EXPECT_TRUE(route->choices[0].can_roll);
  EXPECT_LT(route->choices[0].hopping.energy_j, 0.8 * route->choices[0].rolling.energy_j);
  EXPECT_DOUBLE_EQ(route->estimate.energy_j, route->choices[0].hopping.energy_j);
  config.least_saving = 0.95;
  const auto reluctant = plan({{}, {8.0, 0.0, 0.0}});
  ASSERT_TRUE(reluctant);
  EXPECT_EQ(reluctant->hops(), 0U) << reluctant->choices[0].why;
}

TEST_F(HybridRouteTest, RefusesWithTheReasonWhatCanNeitherBeRolledNorHopped) {
  config.area = {-1.0, -1.5, 10.0, 1.5};
  obstacles.push_back(wall(4.0, 0.0, 2.0, 3.0));
  const auto route = plan({{}, {8.0, 0.0, 0.0}});
  ASSERT_FALSE(route);
  EXPECT_EQ(route.error().code, hal::ErrorCode::refused);
  EXPECT_NE(hal::describe(route.error()).find("too_high"), std::string::npos);
  EXPECT_FALSE(plan({{}}));
  EXPECT_FALSE(plan({{}, {std::nan(""), 0.0, 0.0}}));
}

}  // namespace
}  // namespace forager::flight
