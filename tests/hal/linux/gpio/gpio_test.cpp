#include "hal/linux/gpio.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/hal/digital_contract.hpp"
#include "tests/hal/linux/fake_gpio_calls.hpp"

namespace forager::hal {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

using fake::FakeGpio;

void plug_in_a_pi() {
  FakeGpio::get().reset();
  FakeGpio::get().chips[0] = {.label = "raspberrypi-exp-gpio", .lines = {{.name = "BT_ON"}}};
  FakeGpio::Chip& chip = FakeGpio::get().chips[4];
  chip.label = "pinctrl-bcm2711";
  for (int i = 0; i < 8; ++i) chip.lines.push_back({.name = "GPIO" + std::to_string(i)});
  chip.lines[6].name = "TWICE";
  chip.lines[7].name = "TWICE";
}

class Gpio : public testing::Test {
 protected:
  Gpio() { plug_in_a_pi(); }
  ~Gpio() override { EXPECT_EQ(0U, FakeGpio::get().open_handles()) << "a descriptor was left open"; }
  static fake::GpioLine& line(std::size_t offset) { return FakeGpio::get().chips.at(4).lines.at(offset); }
  template <class T>
  static ErrorCode code(const Result<T>& result) {
    return result ? ErrorCode::invalid_state : result.error().code;
  }
};

GpioLineConfig pi(std::string name) { return {.chip = "pinctrl-bcm2711", .line = std::move(name)}; }

TEST_F(Gpio, FindsChipsByLabelNameAndPathAndLinesByNameAndNumber) {
  for (const char* chip : {"pinctrl-bcm2711", "gpiochip4", "/dev/gpiochip4"})
    for (const char* name : {"GPIO3", "3"}) {
      const auto out = open_gpio_out({.chip = chip, .line = name});
      ASSERT_TRUE(out) << describe(out.error());
      EXPECT_TRUE(line(3).used);
      EXPECT_EQ("forager", line(3).consumer);
    }
  EXPECT_FALSE(line(3).used);
}

TEST_F(Gpio, AnActiveLowOutputNeverShowsAWrongLevel) {
  {
    const auto out = open_gpio_out({.chip = "gpiochip4", .line = "2", .active_low = true});
    ASSERT_TRUE(out);
    EXPECT_TRUE(line(2).level);
    ASSERT_TRUE((*out)->set(true));
    EXPECT_FALSE(line(2).level);
  }
  EXPECT_THAT(line(2).history, ElementsAre(true, false, true));  // inactive, active, inactive at its end
}

TEST_F(Gpio, AnOutputMayKeepItsLevelAtItsEnd) {
  {
    const auto out = open_gpio_out({.chip = "gpiochip4", .line = "2", .at_end = GpioAtEnd::as_is});
    ASSERT_TRUE((*out)->set(true));
  }
  EXPECT_TRUE(line(2).level);
  EXPECT_FALSE(line(2).used);
}

TEST_F(Gpio, AnOutputMayBeginActiveWithoutASpike) {
  const auto out =
      open_gpio_out({.chip = "gpiochip4", .line = "2", .active_low = true, .begin_active = true});
  ASSERT_TRUE(out) << describe(out.error());
  EXPECT_THAT(line(2).history, ElementsAre(false));
}

TEST_F(Gpio, SaysWhoHoldsABusyLine) {
  line(5).used = true;
  line(5).consumer = "spi0 CS1";
  const auto out = open_gpio_out(pi("GPIO5"));
  ASSERT_EQ(ErrorCode::busy, code(out));
  EXPECT_THAT(describe(out.error()),
              HasSubstr("gpio pinctrl-bcm2711/GPIO5: open: \"spi0 CS1\" holds the line"));
}

TEST_F(Gpio, TellsWrongNamesApart) {
  EXPECT_EQ(ErrorCode::not_present, code(open_gpio_out({.chip = "gpiochip9", .line = "0"})));
  EXPECT_EQ(ErrorCode::not_present, code(open_gpio_out({.chip = "no-such-label", .line = "0"})));
  EXPECT_EQ(ErrorCode::not_present, code(open_gpio_out(pi("GPIO99"))));
  EXPECT_EQ(ErrorCode::invalid_argument, code(open_gpio_out(pi("8"))));
  EXPECT_EQ(ErrorCode::invalid_argument, code(open_gpio_out(pi("TWICE"))));
  EXPECT_TRUE(open_gpio_out(pi("7")));
  FakeGpio::get().chips[4].refuse_open = EACCES;
  for (const char* chip : {"gpiochip4", "pinctrl-bcm2711"}) {
    const auto refused = open_gpio_out({.chip = chip, .line = "0"});
    EXPECT_EQ(ErrorCode::permission, code(refused)) << chip;
    EXPECT_THAT(describe(refused.error()), HasSubstr("99-forager.rules"));
  }
}

TEST_F(Gpio, BiasAndDriveReachTheChipOrAreRefused) {
  {
    const auto in = open_gpio_in({.chip = "gpiochip4", .line = "1", .bias = GpioBias::pull_up});
    ASSERT_TRUE(in);
    EXPECT_TRUE((*in)->active().value());
    const auto out = open_gpio_out({.chip = "gpiochip4", .line = "2", .drive = GpioDrive::open_drain});
    ASSERT_TRUE(out);
    EXPECT_NE(0U, line(2).flags & GPIOLINE_FLAG_OPEN_DRAIN);
  }
  FakeGpio::get().chips[4].has_bias = false;
  EXPECT_EQ(ErrorCode::invalid_argument,
            code(open_gpio_in({.chip = "gpiochip4", .line = "1", .bias = GpioBias::pull_up})));
}

TEST_F(Gpio, AGroupChangesInOneCall) {
  const auto group = open_gpio_group({pi("GPIO2"), pi("GPIO4"), pi("GPIO1")});
  ASSERT_TRUE(group) << describe(group.error());
  EXPECT_EQ(3U, (*group)->size());
  const unsigned before = FakeGpio::get().chips[4].sets;
  ASSERT_TRUE((*group)->set(std::array{true, false, true}));
  EXPECT_EQ(1U, FakeGpio::get().chips[4].sets - before);
  EXPECT_TRUE(line(2).level);
  EXPECT_FALSE(line(4).level);
  EXPECT_TRUE(line(1).level);
  EXPECT_EQ(ErrorCode::invalid_argument, (*group)->set(std::array{true}).error().code);
}

TEST_F(Gpio, AGroupIsOfOneKind) {
  GpioLineConfig low = pi("GPIO2");
  low.active_low = true;
  EXPECT_EQ(ErrorCode::invalid_argument, code(open_gpio_group({pi("GPIO1"), low})));
  EXPECT_EQ(ErrorCode::invalid_argument,
            code(open_gpio_group({pi("GPIO1"), {.chip = "gpiochip0", .line = "0"}})));
  EXPECT_EQ(ErrorCode::invalid_argument, code(open_gpio_group({})));
}

TEST_F(Gpio, KernelsThatStampWithTheWallClockAreUnderstood) {
  if (!gpio_library().starts_with("libgpiod 1")) GTEST_SKIP() << "kernels that libgpiod 2 needs never do";
  FakeGpio::get().chips[4].wall_clock_stamps = true;
  const auto in = open_gpio_edges({.chip = "gpiochip4", .line = "1", .edges = GpioEdges::both});
  ASSERT_TRUE(in);
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const Instant at(std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec));
  FakeGpio::get().drive(4, 1, true, at);
  std::array<Edge, 1> edges{};
  ASSERT_EQ(1U, (*in)->edges(edges).value());
  EXPECT_LT(std::chrono::abs(edges[0].at - at), 1s);
}

TEST_F(Gpio, WhatWasNotAskedForIsNotThere) {
  EXPECT_EQ(ErrorCode::invalid_argument, code(open_gpio_edges(pi("GPIO1"))));
  if (gpio_library().starts_with("libgpiod 1")) {
    EXPECT_EQ(ErrorCode::unsupported,
              code(open_gpio_in({.chip = "gpiochip4", .line = "1", .debounce = 1ms})));
  }
}

TEST_F(Gpio, ListsEveryLineAndItsHolder) {
  const auto held = open_gpio_out(pi("GPIO5"));
  const auto facts = list_gpio();
  ASSERT_TRUE(facts);
  ASSERT_EQ(9U, facts->size());
  EXPECT_EQ("BT_ON", facts->front().name);
  EXPECT_EQ("raspberrypi-exp-gpio", facts->front().label);
  const GpioLineFacts& five = (*facts)[6];
  EXPECT_EQ(5U, five.number);
  EXPECT_EQ("forager", five.held_by);
  EXPECT_TRUE(five.output);
}

TEST_F(Gpio, ListingChipsThatMayNotBeOpenedIsAMatterOfPermission) {
  FakeGpio::get().chips[0].refuse_open = EACCES;
  FakeGpio::get().chips[4].refuse_open = EACCES;
  EXPECT_EQ(ErrorCode::permission, code(list_gpio()));
}

class GpioRig final : public contract::DigitalRig {
 public:
  GpioRig() {
    plug_in_a_pi();
    out_ = open_gpio_out({.chip = "gpiochip4", .line = "2", .active_low = true}).value();
    in_ = open_gpio_edges({.chip = "gpiochip4", .line = "1", .active_low = true, .edges = GpioEdges::both})
              .value();
    FakeGpio::get().chips[4].lines[1].level = true;  // inactive
  }
  DigitalOut& out() override { return *out_; }
  bool out_is_active() override { return !FakeGpio::get().chips[4].lines[2].level; }
  EdgeIn& in() override { return *in_; }
  void drive_in(bool active, Instant at) override { FakeGpio::get().drive(4, 1, !active, at); }
  void unplug(bool out) override { FakeGpio::get().chips[4].gone = out; }
  bool keeps_last_edges() override { return gpio_library().find("libgpiod 2") == 0; }

 private:
  std::unique_ptr<DigitalOut> out_;
  std::unique_ptr<EdgeIn> in_;
};

}  // namespace

namespace contract {
INSTANTIATE_TEST_SUITE_P(FakeKernel, DigitalContract,
                         testing::Values(DigitalRigMaker{"Libgpiod",
                                                         [] { return std::make_unique<GpioRig>(); }}),
                         [](const auto& rig) { return rig.param.name; });
}  // namespace contract
}  // namespace forager::hal
