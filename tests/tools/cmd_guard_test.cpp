// What is left on the lines when a program that moves them is killed, or hangs: from outside, on files in
// place of the kernel's.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/tools/bench_command.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/sysfs_tree.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using Wall = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

constexpr std::int64_t kOpen = 1'180'000;
constexpr std::int64_t kLeftLocked = 1'725'000;
constexpr std::int64_t kRightLocked = 1'875'000;
constexpr std::int64_t kEscStop = 1'000'000;

class Guarded : public testing::Test {
 protected:
  // Two brake servos on the chip.
  std::string brakes(const std::string& head = "") {
    return tree_.folder().write(
        "brakes.toml", fmt::format("[board]\nname = \"bench\"\n{0}[brakes]\n"
                                   "left = {{ backend = \"sysfs_pwm\", chip = \"{1}\", channel = 0 }}\n"
                                   "right = {{ backend = \"sysfs_pwm\", chip = \"{1}\", channel = 1 }}\n",
                                   head, tree_.chip()));
  }
  [[nodiscard]] bool locked() const {
    return tree_.pulse_ns(0) == kLeftLocked && tree_.pulse_ns(1) == kRightLocked;
  }
  [[nodiscard]] bool open() const { return tree_.pulse_ns(0) == kOpen && tree_.pulse_ns(1) == kOpen; }

  test::SysfsTree tree_;
};

// How long it takes, by the clock, from the signal to both brakes' locked pulses. A machine that is busy with
// other things stretches single tries, never all of them to seconds: each must lock within 5 s, and the
// quickest within the 100 ms that are promised. On a machine of its own all do.
class KillTimes {
 public:
  // One try; false: something else went wrong, and gtest knows.
  bool add(std::optional<Milliseconds> time) {
    if (!time) return false;
    times_.push_back(*time);
    return true;
  }
  [[nodiscard]] bool enough() const {
    return times_.size() >= kMost || (times_.size() >= kFew && quickest() < 100ms);
  }
  void judge(const std::string& what) {
    ASSERT_FALSE(times_.empty());
    std::sort(times_.begin(), times_.end());
    const double median = times_[times_.size() / 2].count();
    testing::Test::RecordProperty("median_ms", fmt::format("{:.1f}", median));
    fmt::print("{}: median {:.1f} ms, quickest {:.1f} ms, slowest {:.1f} ms of {}\n", what, median,
               times_.front().count(), times_.back().count(), times_.size());
    EXPECT_LT(times_.front(), 100ms);
  }

 private:
  static constexpr std::size_t kFew = 3;
  static constexpr std::size_t kMost = 15;
  [[nodiscard]] Milliseconds quickest() const { return *std::min_element(times_.begin(), times_.end()); }
  std::vector<Milliseconds> times_;
};

template <class Condition>
std::optional<Milliseconds> time_until(Condition condition) {
  const auto start = Wall::now();
  while (Wall::now() - start < 5s) {
    if (condition()) return Wall::now() - start;
    std::this_thread::sleep_for(500us);
  }
  return std::nullopt;
}

TEST_F(Guarded, BrakesLockWhenTheProgramIsKilled) {
  const std::string board = brakes("guard_timeout_ms = 10000\n");
  KillTimes times;
  while (!times.enough()) {
    Program program(
        {"brake", "set", "--arm", "--left", "0", "--right", "0", "--hold", "60", "--board", board});
    ASSERT_TRUE(program.wait_until([&](const ProgramResult&) { return open(); }, 20s))
        << program.so_far().err;
    program.send_signal(SIGKILL);
    ASSERT_TRUE(times.add(time_until([&] { return locked(); }))) << "still open after 5 s";
    const ProgramResult result = program.finish();
    EXPECT_EQ(result.signal, SIGKILL);
    EXPECT_THAT(result.err, AllOf(HasSubstr("forager guard: forager brake died"), HasSubstr("left brake"),
                                  HasSubstr("right brake")));
    EXPECT_THAT(result.err, Not(HasSubstr("NOT SAFE")));
  }
  times.judge("after SIGKILL");
}

TEST_F(Guarded, BrakesLockWhenTheProgramHangsAndItIsKilled) {
  const std::string board = brakes();
  KillTimes times;
  for (int rounds = 0; rounds < 60 && !times.enough(); ++rounds) {
    Program program(
        {"brake", "set", "--arm", "--left", "0", "--right", "0", "--hold", "60", "--board", board});
    // On a machine too busy to let it run every 60 ms it is taken for hung by itself: another try.
    if (!program.wait_until([&](const ProgramResult&) { return open(); }, 20s)) continue;
    program.send_signal(SIGSTOP);
    const auto time = time_until([&] { return locked(); });
    const ProgramResult result = program.finish();
    if (time && *time < 40ms) continue;  // so soon it cannot have been for our signal
    ASSERT_TRUE(times.add(time)) << "still open after 5 s";
    EXPECT_EQ(result.signal, SIGKILL);
    EXPECT_THAT(result.err, HasSubstr("forager brake was silent for 60 ms, and was killed"));
  }
  times.judge("after SIGSTOP");
}

TEST_F(Guarded, AnOrderlyEndNeedsNoGuard) {
  const std::string board = brakes("guard_timeout_ms = 10000\n");
  const ProgramResult result = run_program(
      {"brake", "set", "--arm", "--left", "0", "--right", "0", "--hold", "0.3", "--board", board});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_TRUE(locked());
}

TEST_F(Guarded, EscsAreToldToStopWhenTheProgramIsKilled) {
  const std::string board = tree_.folder().write(
      "escs.toml",
      fmt::format("[board]\nname = \"bench\"\nguard_timeout_ms = 10000\n[esc]\nchip = \"{}\"\n"
                  "motor = [{{ name = \"left\", channel = 0 }}, {{ name = \"right\", channel = 1 }}]\n",
                  tree_.chip()));
  Program program({"esc", "run", "--arm", "--props-off", "the propellers are off", "--throttle", "0.3",
                   "--hold", "60", "--connect-within", "0", "--board", board});
  const auto turns = [&](const ProgramResult&) { return tree_.pulse_ns(0).value_or(0) > 1'060'000; };
  ASSERT_TRUE(program.wait_until(turns, 20s)) << program.so_far().err;
  program.send_signal(SIGKILL);
  EXPECT_TRUE(time_until([&] { return tree_.pulse_ns(0) == kEscStop && tree_.pulse_ns(1) == kEscStop; }));
  EXPECT_THAT(program.finish().err, AllOf(HasSubstr("forager esc died"), HasSubstr("ESCs: safe")));
}

// What systemd calls when a service ended, however it did.
TEST_F(Guarded, SafeLocksWhatAnEarlierProgramLeft) {
  const ProgramResult result = run_program({"guard", "--safe", brakes()});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(locked());
  EXPECT_EQ(result.out,
            fmt::format("left brake (pwm {0}/0): safe\nright brake (pwm {0}/1): safe\n", tree_.chip()));
}

TEST_F(Guarded, OneOutputThatFailsKeepsNoOtherFromBeingLocked) {
  const std::string board = tree_.folder().write(
      "half.toml", fmt::format("[board]\nname = \"bench\"\n[brakes]\n"
                               "left = {{ backend = \"sysfs_pwm\", chip = \"{0}/gone\", channel = 0 }}\n"
                               "right = {{ backend = \"sysfs_pwm\", chip = \"{0}\", channel = 1 }}\n",
                               tree_.chip()));
  const ProgramResult result = run_program({"guard", "--safe", board, "--json"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, AllOf(HasSubstr("there is no such PWM chip"), HasSubstr("dtoverlay")));
  const auto lines = lines_of(result.out);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0]["safe"], false);
  EXPECT_EQ(lines[1]["safe"], true);
  EXPECT_EQ(tree_.pulse_ns(1), kRightLocked);
}

TEST_F(Guarded, ABoardWithoutOutputsIsAMistake) {
  expect_refusal({"guard", "--safe", "sim"}, 2, HasSubstr("no real output"));
  expect_refusal({"guard"}, 2, HasSubstr("--safe"));
}

}  // namespace
}  // namespace forager::tools
