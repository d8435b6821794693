#include "flight/stigmergy.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "hal/random.hpp"
#include "hal/units.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;
using hal::deg_to_rad;
using hal::kPi;
using hal::rad_to_deg;

// Ports as the laboratory's robot has them; weights given as (front, left, back, right).
std::vector<reader::PortWeight> weights(double front, double left, double back, double right) {
  return {{4, 0.0, front}, {2, -kPi / 2, right}, {1, kPi, back}, {3, kPi / 2, left}};
}

// A vehicle that goes where it is told, unless the test says the way is blocked.
struct Walk {
  explicit Walk(const StigmergyConfig& config) : policy(config) { last = policy.begin(pose); }

  Step window(std::vector<reader::PortWeight> heard, std::uint32_t carried = 0) {
    Observation seen;
    now += 3s;
    seen.now = now;
    seen.pose_world = pose;
    seen.weights = heard;
    double sum = 0.0;
    for (const auto& w : heard) sum += w.weight;
    seen.new_tags = static_cast<std::uint32_t>(sum);
    seen.fresh_tags = seen.new_tags - carried;
    if (seen.fresh_tags > 0) tries = 0;
    if (seen.fresh_tags == 0 && last.listen > 0s) ++tries;
    seen.tries = tries;
    seen.blocked = blocked;
    seen.moved_m = moved;
    last = policy.decide(seen);
    blocked = false;
    moved = 0.0;
    return last;
  }
  Step quiet() { return window(weights(0, 0, 0, 0)); }
  // Turns to the step's heading and goes its length, if `free`.
  void obey(bool free = true) {
    pose.yaw_rad = last.heading_rad;
    blocked = last.length_m > 0.0 && !free;
    if (blocked || last.length_m == 0.0) return;
    moved = last.length_m;
    pose.position = pose.position + moved * hal::Vec3{std::cos(pose.yaw_rad), std::sin(pose.yaw_rad), 0.0};
  }

  Stigmergy policy;
  hal::Pose pose;
  hal::Instant now{};
  std::uint32_t tries = 0;
  bool blocked = false;
  double moved = 0.0;
  Step last;
};

StigmergyConfig plain() {
  StigmergyConfig config;
  config.heights_m = {1.8};
  return config;
}

TEST(Pull, PublishedExamples) {
  struct Example {
    double front, left, back, right, theta_deg;
  };
  for (const Example& e : {Example{5, 0, 0, 0, 0},
                           {0, 5, 0, 0, 90},
                           {0, 0, 0, 5, -90},
                           {0, 0, 5, 0, 180},
                           {3, 4, 0, 0, 53.1301},
                           {3, 0, 0, 4, -53.1301},
                           {10, 2, 4, 8, -45}}) {
    const Pull pull = pull_of(weights(e.front, e.left, e.back, e.right));
    EXPECT_NEAR(rad_to_deg(pull.theta_rad), e.theta_deg, 1e-4);
    EXPECT_GT(pull.length, 0.9);
  }
  EXPECT_EQ(pull_of(weights(2, 3, 2, 3)).length, 0.0) << "balanced: no direction, not rounding noise";
  EXPECT_EQ(pull_of({}).length, 0.0);
}

RC_GTEST_PROP(Pull, AnyBearingsTurnTheWayTheTagsAre, ()) {
  // The pull turns with the antennas, whatever their number and order.
  hal::Random random(*rc::gen::arbitrary<std::uint64_t>());
  std::vector<reader::PortWeight> ports(1 + random.below(8));
  for (auto& port : ports) port = {1, random.uniform(-kPi, kPi), static_cast<double>(random.below(20))};
  const double by = random.uniform(-kPi, kPi);
  auto turned = ports;
  for (auto& port : turned) port.bearing_rad = hal::wrap_pi(port.bearing_rad + by);
  std::reverse(turned.begin(), turned.end());
  const Pull before = pull_of(ports);
  const Pull after = pull_of(turned);
  RC_ASSERT(std::abs(before.length - after.length) < 1e-9 * (1.0 + before.total));
  if (before.length > 1e-3)
    RC_ASSERT(std::abs(hal::angle_difference(after.theta_rad, before.theta_rad + by)) < 1e-6);
  RC_ASSERT(before.theta_rad > -kPi && before.theta_rad <= kPi);
}

TEST(Stigmergy, TurnsToTheTagsAndGoesAStep) {
  Walk walk(plain());
  walk.pose.yaw_rad = deg_to_rad(170.0);
  const Step left = walk.window(weights(3, 4, 0, 0));
  EXPECT_EQ(left.kind, DecisionKind::turn_left);
  EXPECT_NEAR(rad_to_deg(left.heading_rad), 170.0 + 53.1301 - 360.0, 1e-3) << "wrapped to (-180, 180]";
  EXPECT_DOUBLE_EQ(left.length_m, 1.0);
  EXPECT_DOUBLE_EQ(left.height_m, 1.8);
  EXPECT_TRUE(left.consume_tags);
  EXPECT_EQ(walk.window(weights(3, 0, 0, 4)).kind, DecisionKind::turn_right);
  EXPECT_EQ(walk.window(weights(5, 1, 0, 1)).kind, DecisionKind::forward);
  EXPECT_EQ(walk.window(weights(0, 1, 6, 0)).kind, DecisionKind::turn_back);
}

TEST(Stigmergy, BalancedPullDecidesNothingAndKeepsTheTags) {
  Walk walk(plain());
  const Step step = walk.window(weights(2, 3, 2, 3));
  EXPECT_EQ(step.kind, DecisionKind::stay);
  EXPECT_EQ(step.length_m, 0.0);
  EXPECT_FALSE(step.consume_tags);
}

TEST(Stigmergy, BalancedForEverStillEnds) {
  Walk walk(plain());
  int windows = 0;
  walk.window(weights(2, 3, 2, 3));
  for (; windows < 50 && walk.last.kind != DecisionKind::land; ++windows) {
    walk.obey();
    walk.window(weights(2, 3, 2, 3), 10);  // the same ten tags, none fresh
  }
  EXPECT_EQ(walk.last.kind, DecisionKind::land);
}

TEST(Stigmergy, SignificanceAsksForMoreThanChance) {
  StigmergyConfig config = plain();
  config.significance = 2.0;
  Walk walk(config);
  EXPECT_FALSE(walk.window(weights(5, 0, 2, 0)).consume_tags) << "|V| = 3 < 2 sqrt(7)";
  const Step step = walk.window(weights(9, 0, 2, 0), 7);
  EXPECT_TRUE(step.consume_tags) << "|V| = 7 > 2 sqrt(11)";
  EXPECT_EQ(step.length_m, 1.0);
}

TEST(Stigmergy, WinnerTakesAllFollowsOneAntenna) {
  StigmergyConfig config = plain();
  config.winner_takes_all = true;
  Walk walk(config);
  EXPECT_NEAR(walk.window(weights(3, 4, 0, 0)).heading_rad, kPi / 2, 1e-12);
  EXPECT_FALSE(walk.window(weights(4, 0, 4, 0)).consume_tags) << "two opposite winners";
}

TEST(Stigmergy, StaysFacingABlockedHeadingWhileTagsArriveThenLooksElsewhere) {
  Walk walk(plain());
  walk.window(weights(1, 9, 0, 0));  // the shelf at the left
  walk.obey(false);
  const double shelf = walk.pose.yaw_rad;
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(walk.window(weights(6, 0, 1, 1)).kind, DecisionKind::stay);
    EXPECT_DOUBLE_EQ(walk.last.heading_rad, shelf);
    EXPECT_TRUE(walk.last.consume_tags);
    walk.obey();
  }
  walk.quiet();
  EXPECT_EQ(walk.last.length_m, 1.0) << "nothing new here: another direction, at once";
  EXPECT_GT(std::abs(hal::angle_difference(walk.last.heading_rad, shelf)), plain().blocked_sector_rad);
}

TEST(Stigmergy, GoesAlongTheAisleOnceMorePullsThere) {
  Walk walk(plain());
  walk.window(weights(1, 9, 0, 0));
  walk.obey(false);
  walk.window(weights(2, 0, 0, 9));  // facing the shelf, the right antenna looks along the aisle
  EXPECT_EQ(walk.last.kind, DecisionKind::turn_right);
  EXPECT_EQ(walk.last.length_m, 1.0);
  EXPECT_NEAR(walk.last.heading_rad, std::atan2(9, 1) - std::atan2(9, 2), 1e-9);
}

TEST(Stigmergy, NeverChoosesAHeadingTwiceThatIsBlockedHere) {
  Walk walk(plain());
  walk.window(weights(5, 0, 0, 0));
  std::vector<double> blocked_headings;
  for (int i = 0; i < 40 && walk.last.kind != DecisionKind::land; ++i) {
    if (walk.last.length_m > 0.0) {
      for (const double old : blocked_headings)
        EXPECT_GT(std::abs(hal::angle_difference(walk.last.heading_rad, old)), plain().blocked_sector_rad);
      blocked_headings.push_back(walk.last.heading_rad);
    }
    walk.obey(false);
    walk.quiet();
  }
  EXPECT_GE(blocked_headings.size(), 5U);
  EXPECT_EQ(walk.last.kind, DecisionKind::land) << "walled in: it gives up";
}

TEST(Stigmergy, ABlockedHeadingIsTriedAgainFromElsewhereAndLater) {
  Walk walk(plain());
  walk.window(weights(5, 0, 0, 0));
  walk.obey(false);
  EXPECT_EQ(walk.window(weights(5, 0, 0, 0)).kind, DecisionKind::stay);
  walk.now += 61s;
  EXPECT_EQ(walk.window(weights(5, 0, 0, 0)).length_m, 1.0) << "who stood there may have gone";
  walk.obey(false);
  walk.pose.position.y += 1.0;
  walk.pose.yaw_rad = kPi / 2;
  EXPECT_EQ(walk.window(weights(0, 0, 0, 5)).length_m, 1.0) << "from another place the way may be free";
}

TEST(Stigmergy, LandsAfterTheTriesAndNeverGoesFarWithoutATag) {
  Walk walk(plain());
  walk.window(weights(5, 0, 0, 0));
  walk.obey();
  double way = 0.0;
  std::uint32_t windows = 0;
  while (walk.last.kind != DecisionKind::land && windows < 100) {
    if (walk.last.listen > 0s) ++windows;
    walk.quiet();
    walk.obey();
    way += walk.moved;
  }
  EXPECT_EQ(walk.last.end, EndReason::no_new_tags);
  EXPECT_EQ(windows, plain().tries);
  EXPECT_LE(way, 2.0) << "two steps of search at most";
}

TEST(Stigmergy, ATagOnTheWayEndsTheTries) {
  Walk walk(plain());
  walk.window(weights(5, 0, 0, 0));
  walk.quiet();
  walk.quiet();
  EXPECT_EQ(walk.tries, 2U);
  walk.obey();
  walk.window(weights(0, 1, 0, 0));
  EXPECT_EQ(walk.last.kind, DecisionKind::turn_left);
}

TEST(Stigmergy, TriesTheNextHeightWhenOneYieldsNothing) {
  StigmergyConfig config = plain();
  config.heights_m = {1.8, 3.0, 4.2};
  Walk walk(config);
  EXPECT_DOUBLE_EQ(walk.window(weights(5, 0, 0, 0)).height_m, 1.8);
  walk.obey();
  walk.quiet();
  EXPECT_DOUBLE_EQ(walk.quiet().height_m, 3.0);
  EXPECT_DOUBLE_EQ(walk.window(weights(0, 4, 0, 0)).height_m, 3.0) << "stays where it finds";
  walk.obey();
  walk.quiet();
  EXPECT_DOUBLE_EQ(walk.quiet().height_m, 4.2);
  EXPECT_DOUBLE_EQ(walk.quiet().height_m, 1.8) << "and comes round before it gives up";
  for (int i = 0; i < 30 && walk.last.kind != DecisionKind::land; ++i, walk.obey()) walk.quiet();
  EXPECT_EQ(walk.last.kind, DecisionKind::land);
}

TEST(Stigmergy, MemoryPullsOnToWhereTagsWereHeard) {
  StigmergyConfig config = plain();
  Walk forgetful(config);
  config.memory = true;
  Walk mindful(config);
  for (Walk* walk : {&forgetful, &mindful}) {
    walk->window(weights(4, 20, 0, 0));  // many at the left
    walk->pose.position.x += 0.5;        // carried on a little by the wind
    walk->window(weights(1, 0, 0, 0));
  }
  EXPECT_NEAR(forgetful.last.heading_rad, 0.0, 1e-9);
  EXPECT_GT(mindful.last.heading_rad, deg_to_rad(45.0));
}

}  // namespace
}  // namespace forager::flight
