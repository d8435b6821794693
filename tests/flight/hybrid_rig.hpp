#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "flight/hybrid_mode.hpp"
#include "mocks/text_journal.hpp"
#include "tests/flight/fake_autopilot.hpp"

namespace forager::flight::test {

// Rolls the fake autopilot's body along its way, straight from corner to corner, and hands on what is seen.
class FakeGround final : public GroundDriver {
 public:
  FakeGround(FakeAutopilot& body, VisionFilter& vision) : body_(&body), vision_(&vision) {}
  bool block_next = false;
  bool fail_next = false;
  std::vector<std::vector<hal::Vec3>> ways;
  int halts = 0;
  void halt() noexcept override {
    ++halts;
    status_.state = GroundState::parked;
  }

 private:
  hal::Result<> do_begin(const std::vector<hal::Vec3>& way, hal::Instant) override {
    ways.push_back(way);
    at_ = 1;
    status_ = {GroundState::driving, {}};
    return {};
  }
  void do_update(hal::Instant now) override {
    if (status_.state != GroundState::driving) return;
    EXPECT_FALSE(body_->state().armed && body_->body.position.z > 0.05) << "wheels do not drive in the air";
    if (fail_next || block_next) {
      status_ = {fail_next ? GroundState::failed : GroundState::blocked, "a box"};
      fail_next = block_next = false;
      return;
    }
    hal::PoseSample seen;
    seen.stamp = now;
    seen.pose = body_->body;
    if (const auto passed = vision_->update(seen, now)) body_->send_vision(*passed);
    const hal::Vec3 goal = ways.back()[at_];
    hal::Vec3 way = goal - body_->body.position;
    way.z = 0.0;
    const double left = hal::norm(way);
    body_->body.yaw_rad = std::atan2(way.y, way.x);
    body_->body.position = body_->body.position + std::min(1.0, 0.01 / std::max(left, 1e-9)) * way;
    if (left < 0.011 && ++at_ == ways.back().size()) status_ = {GroundState::arrived, {}};
  }
  [[nodiscard]] const GroundStatus& do_status() const override { return status_; }

  FakeAutopilot* body_;
  VisionFilter* vision_;
  GroundStatus status_;
  std::size_t at_ = 1;
};

// Sees the body as it is.
class BodyPose final : public hal::PoseSource {
 public:
  explicit BodyPose(FakeAutopilot& body) : body_(&body) {}
  bool see = true;

 private:
  hal::Result<std::optional<hal::PoseSample>> do_poll(hal::Instant now) override {
    if (!see) return std::nullopt;
    hal::PoseSample sample;
    sample.stamp = now;
    sample.pose = body_->body;
    return sample;
  }
  FakeAutopilot* body_;
};

class HybridModeTest : public ::testing::Test {
 protected:
  HybridModeTest() : ground(autopilot, vision), pose(autopilot) {
    config.area = {-1.0, -1.5, 12.0, 1.5};
    bar = {{4.0, 0.0, 0.0}, 0.1, 2.0, 0.0, 0.4};
  }
  void start(std::vector<HopObstacle> planned, std::vector<HopObstacle> known) {
    const std::vector<hal::Vec3> places{{}, {8.0, 0.0, 0.0}};
    auto route = plan_route(places, 0.0, planned, config, EnergyModel({}));
    ASSERT_TRUE(route) << hal::describe(route.error());
    mode = std::make_unique<HybridMode>(mode_config, HybridDevices{autopilot, ground, pose, vision, journal},
                                        *route, std::move(known), now);
  }
  void tick() {
    now += std::chrono::milliseconds(20);
    mode->update(now);
    highest = std::max(highest, autopilot.body.position.z);
    const hal::Vec3 at = autopilot.body.position;
    if (std::abs(at.x - bar.centre_world.x) < bar.half_x_m + 0.65)
      lowest_over = std::min(lowest_over, at.z - *bar.height_m);
  }
  void run(hal::Duration time) {
    for (const hal::Instant end = now + time; now < end && !mode->done();) tick();
  }
  bool run_until(HybridPhase phase) {
    for (int i = 0; i < 6000 && mode->status().phase != phase; ++i) tick();
    return mode->status().phase == phase;
  }

  FakeAutopilot autopilot;
  VisionFilter vision{VisionFilterConfig{}};
  FakeGround ground;
  BodyPose pose;
  mocks::TextJournal journal;
  HybridRouteConfig config;
  HybridConfig mode_config;
  HopObstacle bar;
  std::unique_ptr<HybridMode> mode;
  hal::Instant now{std::chrono::seconds(1)};
  double highest = 0.0;
  double lowest_over = 1e9;
};

}  // namespace forager::flight::test
