// Seeded campaigns against the brake pair: whatever comes, it must be locked, or on its way there, when
// nobody may command it.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "hal/random.hpp"
#include "mocks/fake_pwm.hpp"
#include "mocks/text_journal.hpp"
#include "servo/brakes.hpp"
#include "servo/pwm_brake.hpp"

namespace forager::servo {
namespace {

using namespace std::chrono_literals;

constexpr hal::Duration kStep = 10ms;
constexpr hal::Duration kBound = 300ms;

struct Rig {
  explicit Rig(std::uint64_t seed) : random(seed) {
    brakes.emplace(left, right, journal, BrakePairConfig{}, now);
  }
  void step() {
    now += kStep;
    group.tick(now);
    brakes->update(now);
  }
  [[nodiscard]] bool locked(bool left_one) const {
    return group_pulse(left_one) == (left_one ? hal::Duration(1725us) : hal::Duration(1875us));
  }
  [[nodiscard]] hal::Duration group_pulse(bool left_one) const {
    return const_cast<mocks::FakePwmGroup&>(group).channel(left_one ? 0 : 1).pulse().value_or(0ns);
  }
  hal::Random random;
  hal::Instant now{1s};
  mocks::TextJournal journal;
  mocks::FakePwmGroup group{"timer", 2};
  PwmBrake left = PwmBrake::create(group.channel(0), laboratory_left()).value();
  PwmBrake right = PwmBrake::create(group.channel(1), laboratory_right()).value();
  std::optional<BrakePair> brakes;
};

void disturb(Rig& rig, hal::Instant& valid_until) {
  const double roll = rig.random.uniform();
  if (roll < 0.10) {
    valid_until = rig.now + std::chrono::milliseconds(rig.random.below(400));
    rig.brakes->command({rig.random.uniform(-0.5, 1.5), rig.random.uniform(-0.5, 1.5), valid_until});
  } else if (roll < 0.102) {
    rig.brakes->halt();
  } else if (roll < 0.12) {
    rig.brakes->resume(rig.now);
  } else if (roll < 0.13) {
    static_cast<void>(rig.brakes->clear_fault(rig.now));
  } else if (roll < 0.30) {
    rig.brakes->observe({rig.random.uniform(-0.1, 1.0), rig.random.uniform(-1.0, 1.0), rig.now});
  } else if (roll < 0.301) {
    rig.group.channel(rig.random.below(2))
        .fail_next({hal::ErrorCode::no_ack, "chip", "write", "no answer", ""});
  }
}

TEST(BrakeCampaign, NobodyInChargeMeansLockedWithin300Milliseconds) {
  std::uint64_t followed = 0;
  std::uint64_t judged = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Rig rig(seed);
    hal::Instant valid_until{hal::Duration::min()};
    hal::Instant idle_since = rig.now;
    for (int i = 0; i < 1000; ++i) {
      disturb(rig, valid_until);
      rig.step();
      const BrakeState state = rig.brakes->state();
      if (state == BrakeState::following) {
        ++followed;
        ASSERT_LT(rig.now, valid_until) << "seed " << seed << ": follows a command that has run out";
      }
      ASSERT_EQ(rig.brakes->thrust_allowed(), state == BrakeState::following);
      const bool in_charge = state == BrakeState::following || state == BrakeState::faulted;
      if (in_charge) idle_since = rig.now;
      if (!in_charge && rig.now - idle_since >= kBound) {
        ++judged;
        ASSERT_TRUE(rig.locked(true) && rig.locked(false)) << "seed " << seed << " at step " << i;
      }
    }
  }
  EXPECT_GT(followed, 10'000U);
  EXPECT_GT(judged, 10'000U);
}

// One output dies for good at a random moment of a drive; the vehicle goes where its wheels let it.
TEST(BrakeCampaign, OneDeadBrakeNeverEndsInASpin) {
  constexpr double kHalfTrack = 0.5;
  double worst_turn_rad = 0.0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    Rig rig(seed);
    const bool dead_is_left = rig.random.chance(0.5);
    const bool stuck_locked = rig.random.chance(0.3);
    const bool pose_there = rig.random.chance(0.7);
    double speed_m_s = rig.random.uniform(0.1, 0.6);
    double yaw_rad_s = 0.0;
    double turned_rad = 0.0;
    for (int i = 0; i < 40; ++i) {
      rig.brakes->command(both_open(rig.now + 100ms));
      rig.step();
    }
    rig.group.channel(dead_is_left ? 0 : 1).disconnect();
    rig.brakes->command(both_locked(rig.now + 10s));
    for (int i = 0; i < 800; ++i) {
      rig.step();
      const bool good = rig.locked(!dead_is_left);
      const bool left_holds = dead_is_left ? stuck_locked : good;
      const bool right_holds = dead_is_left ? good : stuck_locked;
      // A locked wheel turns what speed there is into a turn about itself; thrust is gone.
      if (left_holds && right_holds) {
        speed_m_s = std::max(0.0, speed_m_s - 0.03);
        yaw_rad_s *= 0.7;
      } else if (left_holds || right_holds) {
        const double side = left_holds ? 1.0 : -1.0;
        yaw_rad_s = side * std::min(std::abs(yaw_rad_s) + 0.04, speed_m_s / kHalfTrack);
        speed_m_s = std::max(0.0, speed_m_s - 0.006);
      } else {
        yaw_rad_s *= 0.9;
        speed_m_s = std::max(0.0, speed_m_s - 0.0025);
      }
      turned_rad += yaw_rad_s * hal::to_seconds(kStep);
      if (pose_there) rig.brakes->observe({speed_m_s, yaw_rad_s, rig.now});
    }
    EXPECT_EQ(rig.brakes->state(), BrakeState::faulted) << "seed " << seed;
    EXPECT_TRUE(rig.brakes->status().cut_thrust);
    EXPECT_TRUE(rig.locked(!dead_is_left)) << "seed " << seed << ": it stays locked in the end";
    EXPECT_LT(speed_m_s, 0.05) << "seed " << seed;
    worst_turn_rad = std::max(worst_turn_rad, std::abs(turned_rad));
  }
  EXPECT_LT(worst_turn_rad, hal::deg_to_rad(45.0));
  RecordProperty("worst_turn_deg", std::to_string(hal::rad_to_deg(worst_turn_rad)));
}

}  // namespace
}  // namespace forager::servo
