#include "boards/pin_loopback.hpp"

#include <gtest/gtest.h>

#include "mocks/fake_digital_in.hpp"
#include "mocks/virtual_clock.hpp"

namespace forager::boards {
namespace {

using namespace std::chrono_literals;

// An output and the wire behind it, as the test bends it.
class Wire final : public hal::DigitalOut {
 public:
  Wire(mocks::FakeDigitalIn& in, const hal::Clock& clock) : in_(&in), clock_(&clock) {}
  hal::Duration delay = 0ns;
  bool inverted = false;
  int bounces_at = -1;  // at this set the contact bounces
  int off_from = 1000;  // from this set on it is off
  bool level = false;

 private:
  hal::Result<> do_set(bool active) override {
    if (active == level) return {};
    level = active;
    ++sets_;
    if (sets_ >= off_from) return {};
    in_->drive(active != inverted, clock_->now() + delay);
    if (sets_ == bounces_at) {
      in_->drive(active == inverted, clock_->now() + delay);
      in_->drive(active != inverted, clock_->now() + delay);
    }
    return {};
  }
  std::string_view do_name() const override { return "out"; }
  mocks::FakeDigitalIn* in_;
  const hal::Clock* clock_;
  int sets_ = 0;
};

class PinLoopbackTest : public testing::Test {
 protected:
  PinLoopback::Result run() {
    PinLoopback test(wire_, in_, {.toggles = 20});
    for (int i = 0; i < 10000; ++i) {
      const auto going = test.update(clock_.now());
      EXPECT_TRUE(going.has_value());
      if (!going || !*going) break;
      clock_.advance(1ms);
    }
    EXPECT_FALSE(wire_.level) << "it ended with the output active";
    return test.result();
  }
  mocks::VirtualClock clock_;
  mocks::FakeDigitalIn in_{"in"};
  Wire wire_{in_, clock_};
};

TEST_F(PinLoopbackTest, CountsAndTimesEveryEdge) {
  wire_.delay = 35us;
  const auto result = run();
  EXPECT_EQ(result.fault, "");
  EXPECT_EQ(result.edges, 20U);
  EXPECT_EQ(result.extra, 0U);
  ASSERT_EQ(result.latency.size(), 20U);
  for (const hal::Duration latency : result.latency) EXPECT_EQ(latency, 35us);
}

TEST_F(PinLoopbackTest, NamesEachFault) {
  wire_.off_from = 0;
  EXPECT_EQ(run().fault, "no edge came: the two pins are not wired together");
}

TEST_F(PinLoopbackTest, ALooseContact) {
  wire_.off_from = 8;
  EXPECT_EQ(run().fault, "edge 8 of 20 did not come: a loose contact");
}

TEST_F(PinLoopbackTest, AnInputThatGoesTheOtherWay) {
  wire_.inverted = true;
  in_.drive(true, clock_.now());
  EXPECT_EQ(run().fault, "the input goes the other way: one of the two is active-low");
}

TEST_F(PinLoopbackTest, AContactThatBounces) {
  wire_.bounces_at = 5;
  const auto result = run();
  EXPECT_EQ(result.extra, 2U);
  EXPECT_EQ(result.fault, "2 edges came that nobody caused: noise, or a bad contact");
}

}  // namespace
}  // namespace forager::boards
