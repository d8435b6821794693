// The GPIO backend on the kernel's gpio-sim.
#include "hal/linux/gpio.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>

#include "tests/hal/digital_contract.hpp"
#include "tests/kernel/gpio_sim.hpp"
#include "tests/kernel/user.hpp"

namespace forager::kernel {
namespace {

using namespace std::chrono_literals;
using hal::Duration;
using hal::Edge;
using hal::ErrorCode;
using hal::Instant;
using testing::HasSubstr;

Instant now() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return Instant(std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec));
}

void sleep_until(Instant when) {
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(when.time_since_epoch());
  const timespec time{whole.count(), (when.time_since_epoch() - whole).count()};
  ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr);
}

std::vector<GpioSim::Line> machine_lines() {
  return {{"GPIO0"}, {"BUTTON"}, {"BRAKE_LEFT"},          {"BRAKE_RIGHT"},
          {"TWICE"}, {"TWICE"},  {"CAM_RESET", "camera"}, {""}};
}

class GpioOnAKernel : public testing::Test {
 protected:
  template <class T>
  static ErrorCode code(const hal::Result<T>& result) {
    return result ? ErrorCode::invalid_state : result.error().code;
  }
  static hal::GpioLineConfig line(std::string name) {
    return {.chip = "pinctrl-bench", .line = std::move(name)};
  }
  GpioSim other_{"another-chip", {{"GPIO0"}}};
  GpioSim sim_{"pinctrl-bench", machine_lines()};
};

TEST_F(GpioOnAKernel, ChipsHaveLabelsNamesAndPathsAndLinesNamesAndNumbers) {
  for (const std::string& chip : {std::string("pinctrl-bench"), sim_.chip(), "/dev/" + sim_.chip()})
    for (const char* name : {"BRAKE_LEFT", "2"}) {
      const auto out = hal::open_gpio_out({.chip = chip, .line = name});
      ASSERT_TRUE(out) << describe(out.error());
      ASSERT_TRUE((*out)->set(true));
      EXPECT_TRUE(sim_.level(2));
    }
  EXPECT_FALSE(sim_.level(2)) << "inactive at its end";
}

TEST_F(GpioOnAKernel, ABusyLineSaysWhoHoldsIt) {
  const auto hogged = hal::open_gpio_out(line("CAM_RESET"));
  ASSERT_EQ(ErrorCode::busy, code(hogged));
  EXPECT_THAT(describe(hogged.error()),
              HasSubstr("gpio pinctrl-bench/CAM_RESET: open: \"camera\" holds the line"));
  hal::GpioLineConfig mine = line("GPIO0");
  mine.consumer = "another program";
  const auto held = hal::open_gpio_in(mine);
  ASSERT_TRUE(held) << describe(held.error());
  const auto second = hal::open_gpio_out(line("0"));
  ASSERT_EQ(ErrorCode::busy, code(second));
  EXPECT_THAT(describe(second.error()), HasSubstr("\"another program\" holds the line"));
}

TEST_F(GpioOnAKernel, WrongNamesAreToldApart) {
  EXPECT_EQ(ErrorCode::not_present, code(hal::open_gpio_out({.chip = "gpiochip63", .line = "0"})));
  EXPECT_EQ(ErrorCode::not_present, code(hal::open_gpio_out({.chip = "no-such-label", .line = "0"})));
  EXPECT_EQ(ErrorCode::unsupported, code(hal::open_gpio_out({.chip = "/dev/null", .line = "0"})));
  EXPECT_EQ(ErrorCode::not_present, code(hal::open_gpio_out(line("GPIO99"))));
  EXPECT_EQ(ErrorCode::invalid_argument, code(hal::open_gpio_out(line("8"))));
  EXPECT_EQ(ErrorCode::invalid_argument, code(hal::open_gpio_out(line("TWICE"))));
  EXPECT_TRUE(hal::open_gpio_out(line("5")));
}

TEST_F(GpioOnAKernel, PolarityAndBiasReachThePin) {
  hal::GpioLineConfig low = line("BRAKE_LEFT");
  low.active_low = true;
  const auto out = hal::open_gpio_out(low);
  ASSERT_TRUE(out) << describe(out.error());
  EXPECT_TRUE(sim_.level(2));
  ASSERT_TRUE((*out)->set(true));
  EXPECT_FALSE(sim_.level(2));
  hal::GpioLineConfig pulled = line("BUTTON");
  pulled.bias = hal::GpioBias::pull_up;
  const auto in = hal::open_gpio_in(pulled);
  ASSERT_TRUE(in) << describe(in.error());
  EXPECT_TRUE((*in)->active().value());
  sim_.drive(1, false);
  EXPECT_FALSE((*in)->active().value());
}

TEST_F(GpioOnAKernel, AGroupSetsAllOfItsLines) {
  const auto group = hal::open_gpio_group({line("BRAKE_RIGHT"), line("GPIO0"), line("BRAKE_LEFT")});
  ASSERT_TRUE(group) << describe(group.error());
  ASSERT_TRUE((*group)->set(std::array{true, false, true}));
  EXPECT_TRUE(sim_.level(3) && !sim_.level(0) && sim_.level(2));
  EXPECT_EQ(ErrorCode::busy, code(hal::open_gpio_out(line("BRAKE_LEFT"))));
}

TEST_F(GpioOnAKernel, ListsEveryLineAndItsHolder) {
  const auto held = hal::open_gpio_out(line("BRAKE_LEFT"));
  const auto facts = hal::list_gpio();
  ASSERT_TRUE(facts) << describe(facts.error());
  const auto ours = std::count_if(facts->begin(), facts->end(), [](const hal::GpioLineFacts& line) {
    return line.label == "pinctrl-bench" ||
           line.label == "another-chip";  // the machine may have its own, too
  });
  EXPECT_EQ(9, ours);
  const auto find = [&](const std::string& name) {
    for (const hal::GpioLineFacts& line : *facts)
      if (line.name == name && line.label == "pinctrl-bench") return line;
    return hal::GpioLineFacts{};
  };
  EXPECT_EQ("forager", find("BRAKE_LEFT").held_by);
  EXPECT_TRUE(find("BRAKE_LEFT").output);
  EXPECT_EQ(2U, find("BRAKE_LEFT").number);
  EXPECT_EQ("camera", find("CAM_RESET").held_by);
  EXPECT_EQ("", find("BUTTON").held_by);
}

TEST_F(GpioOnAKernel, NobodyMayNotAndTheGroupMay) {
  const auto try_it = [] {
    const auto out = hal::open_gpio_out({.chip = "pinctrl-bench", .line = "BRAKE_LEFT"});
    return out ? "opened" : std::string(to_string(out.error().code)) + ": " + describe(out.error());
  };
  const std::string refused = as_nobody({}, try_it);
  EXPECT_THAT(refused, HasSubstr("permission: gpio pinctrl-bench/BRAKE_LEFT: open: "));
  EXPECT_THAT(refused, HasSubstr("99-forager.rules"));
  EXPECT_THAT(as_nobody({}, [] { return std::string(to_string(hal::list_gpio().error().code)); }),
              HasSubstr("permission"));
  std::string allowed;  // udev gives the chip to the group a moment after it appears
  for (int i = 0; i < 100 && allowed != "opened"; ++i) {
    sleep_until(now() + 20ms);
    allowed = as_nobody({"gpio"}, try_it);
  }
  EXPECT_EQ("opened", allowed);
}

// gpio-sim's interrupts wait for the next tick of the kernel: pins are driven in the middle between two, and
// in virtual time the stamps are those of the ticks, to the nanosecond.
constexpr Duration kTick = 10ms;

Instant next_tick() {
  const Instant moment = now();
  return moment + 2 * kTick - moment.time_since_epoch() % kTick;
}

// Reading the clock costs virtual time, so stamps are exact once nobody else has anything to do: udev with a
// new chip, the kernel with a new line.
void let_others_finish() { sleep_until(now() + 1s); }

void drive_for_stamp(const GpioSim& sim, unsigned line, bool high, Instant stamp) {
  sleep_until(stamp - kTick / 2);
  sim.drive(line, high);
}

TEST(GpioInVirtualTime, EdgesAreStampedToTheNanosecondHoweverLongNobodyLooks) {
  GpioSim sim("bench", {{"IN"}});
  const auto in =
      hal::open_gpio_edges({.chip = "bench", .line = "IN", .edges = hal::GpioEdges::both}).value();
  let_others_finish();
  const Instant start = next_tick();
  for (int i = 0; i < 10; ++i) drive_for_stamp(sim, 0, i % 2 == 0, start + i * 20ms);
  sleep_until(start + 600s);
  std::array<Edge, 16> edges{};
  ASSERT_EQ(10U, in->edges(edges).value());
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(start + i * 20ms, edges.at(i).at) << i;
    EXPECT_EQ(i % 2 == 0, edges.at(i).active);
  }
}

// When the pin was driven, and when the test says that was.
struct Driven {
  Instant at;
  Instant told;
};

// The kernel's stamp of an edge lies between the moment the pin was driven and the next such moment: the
// edge is given the time that belongs to it.
class ToldEdges final : public hal::EdgeIn {
 public:
  ToldEdges(std::unique_ptr<hal::EdgeIn> in, const std::vector<Driven>& driven)
      : in_(std::move(in)), driven_(&driven) {}

 private:
  hal::Result<bool> do_active() override { return in_->active(); }
  hal::Result<std::size_t> do_edges(std::span<Edge> into) override {
    const auto count = in_->edges(into);
    for (Edge& edge : into.first(count.value_or(0))) {
      const auto next = std::find_if(driven_->begin(), driven_->end(),
                                     [&](const Driven& driven) { return driven.at > edge.at; });
      edge.at = next == driven_->begin() ? Instant::max() : std::prev(next)->told;
    }
    return count;
  }
  std::string_view do_name() const override { return in_->name(); }

  std::unique_ptr<hal::EdgeIn> in_;
  const std::vector<Driven>* driven_;
};

class SimRig final : public hal::contract::DigitalRig {
 public:
  SimRig() { open(); }
  hal::DigitalOut& out() override { return *out_; }
  bool out_is_active() override { return !sim_.level(0); }
  hal::EdgeIn& in() override { return *in_; }
  void drive_in(bool active, Instant at) override {
    driven_.push_back({now(), at});
    sim_.drive(1, !active);
    sleep_until(now() + 2 * kTick);
  }
  // What was open on a chip that went stays dead: a program opens it again, and so does this.
  void unplug(bool out) override {
    if (out) return sim_.unplug();
    out_.reset();
    in_.reset();
    sim_.plug_in();
    open();
  }

 private:
  void open() {
    out_ = hal::open_gpio_out({.chip = "bench", .line = "OUT", .active_low = true}).value();
    sim_.drive(1, true);  // inactive
    auto in = hal::open_gpio_edges(
        {.chip = "bench", .line = "IN", .active_low = true, .edges = hal::GpioEdges::both});
    in_ = std::make_unique<ToldEdges>(std::move(in).value(), driven_);
  }
  GpioSim sim_{"bench", {{"OUT"}, {"IN"}}};
  std::vector<Driven> driven_;
  std::unique_ptr<hal::DigitalOut> out_;
  std::unique_ptr<hal::EdgeIn> in_;
};

}  // namespace
}  // namespace forager::kernel

namespace forager::hal::contract {
INSTANTIATE_TEST_SUITE_P(Kernel, DigitalContract,
                         testing::Values(DigitalRigMaker{"GpioSim",
                                                         [] { return std::make_unique<kernel::SimRig>(); }}),
                         [](const auto& rig) { return rig.param.name; });
}  // namespace forager::hal::contract
