#pragma once

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <memory>
#include <string>

#include "hal/digital_in.hpp"
#include "hal/digital_out.hpp"

// The contracts of hal::DigitalOut and hal::EdgeIn as tests, for every implementation alike. Include it in
// one file of a test program and instantiate DigitalContract with rigs.
namespace forager::hal::contract {

class DigitalRig {
 public:
  virtual ~DigitalRig() = default;
  virtual DigitalOut& out() = 0;
  virtual bool out_is_active() = 0;  // measured outside
  virtual EdgeIn& in() = 0;
  virtual void drive_in(bool active, Instant at) = 0;
  virtual void unplug(bool out) = 0;
  virtual bool keeps_last_edges() { return false; }  // of too many; else the first ones
};

struct DigitalRigMaker {
  std::string name;
  std::function<std::unique_ptr<DigitalRig>()> make;
};

class DigitalContract : public testing::TestWithParam<DigitalRigMaker> {
 protected:
  std::unique_ptr<DigitalRig> rig_ = GetParam().make();
};

using namespace std::chrono_literals;

TEST_P(DigitalContract, AnOutputStartsInactive) { EXPECT_FALSE(rig_->out_is_active()); }

TEST_P(DigitalContract, AnOutputIsWhatItWasToldLast) {
  for (const bool active : {true, true, false, true, false}) {
    ASSERT_TRUE(rig_->out().set(active).has_value());
    EXPECT_EQ(active, rig_->out_is_active());
  }
  EXPECT_FALSE(rig_->out().name().empty());
}

TEST_P(DigitalContract, AnInputReadsWhatDrivesIt) {
  for (const bool active : {true, false, true}) {
    rig_->drive_in(active, Instant(1s));
    EXPECT_EQ(active, rig_->in().active().value());
  }
}

TEST_P(DigitalContract, EdgesComeInOrderWithTheirTimes) {
  std::array<Edge, 8> edges{};
  EXPECT_EQ(0U, rig_->in().edges(edges).value());
  rig_->drive_in(true, Instant(1000ms));
  rig_->drive_in(false, Instant(1001ms));
  rig_->drive_in(true, Instant(2000ms));
  ASSERT_EQ(2U, rig_->in().edges(std::span(edges).first(2)).value());
  EXPECT_EQ(Instant(1000ms), edges[0].at);
  EXPECT_TRUE(edges[0].active);
  EXPECT_EQ(Instant(1001ms), edges[1].at);
  EXPECT_FALSE(edges[1].active);
  ASSERT_EQ(1U, rig_->in().edges(edges).value());
  EXPECT_EQ(Instant(2000ms), edges[0].at);
  EXPECT_EQ(0U, rig_->in().edges(edges).value());
}

TEST_P(DigitalContract, TheQueueOfEdgesIsFiniteAndKeepsOneEndOfThem) {
  for (int i = 0; i < 40; ++i) rig_->drive_in(i % 2 == 0, Instant(i * 1ms));
  std::array<Edge, 64> edges{};
  ASSERT_EQ(16U, rig_->in().edges(edges).value());
  EXPECT_EQ(rig_->keeps_last_edges() ? Instant(24ms) : Instant(0ms), edges[0].at);
}

TEST_P(DigitalContract, UnpluggedItSaysSo) {
  rig_->unplug(true);
  const auto set = rig_->out().set(true);
  ASSERT_FALSE(set.has_value());
  EXPECT_EQ(ErrorCode::disconnected, set.error().code);
  EXPECT_FALSE(set.error().device.empty());
  EXPECT_EQ(ErrorCode::disconnected, rig_->in().active().error().code);
  rig_->unplug(false);
  ASSERT_TRUE(rig_->out().set(true).has_value());
  EXPECT_TRUE(rig_->out_is_active());
}

}  // namespace forager::hal::contract
