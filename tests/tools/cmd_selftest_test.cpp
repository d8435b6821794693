// `forager selftest` from outside, on emulated pins and on libgpiod over a fake kernel.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "tests/tools/fake_machine.hpp"
#include "tests/tools/program.hpp"

namespace forager::tools {
namespace {

using testing::HasSubstr;

ProgramResult on_pins(const std::vector<std::string>& arguments, const std::string& gpio = {}) {
  return run_program(arguments, FakeMachine{.gpio = gpio}.options());
}

class CmdSelftest : public testing::Test {
 protected:
  void SetUp() override {
    if (!built_with("libgpiod")) GTEST_SKIP() << "built without libgpiod";
  }
};

TEST_F(CmdSelftest, TwoWiredPinsGiveEveryEdge) {
  const ProgramResult sim =
      run_program({"selftest", "--board", "sim", "--out", "sim/OUT2", "--in", "sim/IN2", "--arm"});
  EXPECT_EQ(sim.exit_code, 0) << sim.err;
  EXPECT_EQ(
      sim.out,
      "sim/OUT2 to sim/IN2: 100 toggles, 100 edges, 0 extra; from set to edge 0.0 us p50, 0.0 us p99, 0.0 us "
      "max\n");
  const ProgramResult pins = on_pins(
      {"selftest", "--out", "gpiochip0/17", "--in", "gpiochip0/27", "--arm", "--count", "20", "--json"});
  EXPECT_EQ(pins.exit_code, 0) << pins.err;
  EXPECT_EQ(nlohmann::json::parse(pins.out)["edges"], 20);
  EXPECT_GT(nlohmann::json::parse(pins.out)["latency_max_us"], 0.0);
}

TEST_F(CmdSelftest, AWireThatIsOffFailsTheCheck) {
  const ProgramResult off =
      on_pins({"selftest", "--out", "gpiochip0/17", "--in", "gpiochip0/27", "--arm"}, "loose");
  EXPECT_EQ(off.exit_code, 4);
  EXPECT_EQ(off.err,
            "forager: gpiochip0/17 to gpiochip0/27: no edge came: the two pins are not wired together\n");
  const ProgramResult other =
      run_program({"selftest", "--board", "sim", "--out", "sim/OUT2", "--in", "sim/IN3", "--arm"});
  EXPECT_EQ(other.exit_code, 4);
  const ProgramResult unsaid = run_program({"selftest", "--out", "gpiochip0/17"});
  EXPECT_EQ(unsaid.exit_code, 2);
  EXPECT_THAT(unsaid.err, HasSubstr("--out LINE --in LINE, or --serial PORT"));
}

// A serial line whose far end sends everything back, or nothing.
class FarEnd {
 public:
  explicit FarEnd(bool echoes) : master_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0) throw std::runtime_error("no pty");
    thread_ = std::thread([this, echoes] {
      std::array<char, 4096> bytes{};
      while (!ended_) {
        const ssize_t got = read(master_, bytes.data(), bytes.size());
        if (got > 0 && echoes)
          static_cast<void>(!write(master_, bytes.data(), static_cast<std::size_t>(got)));
        if (got <= 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
  }
  ~FarEnd() {
    ended_ = true;
    thread_.join();
    close(master_);
  }
  FarEnd(const FarEnd&) = delete;
  FarEnd& operator=(const FarEnd&) = delete;
  [[nodiscard]] std::string port() const { return ptsname(master_); }

 private:
  int master_;
  std::atomic<bool> ended_ = false;
  std::thread thread_;
};

TEST(CmdSelftestSerial, EveryByteComesBackOrTheCheckFails) {
  const FarEnd wired(true);
  const ProgramResult good = run_program({"selftest", "--serial", wired.port(), "--count", "1000", "--json"});
  EXPECT_EQ(good.exit_code, 0) << good.err;
  EXPECT_THAT(good.out, HasSubstr("\"sent\":1000,\"back\":1000,\"wrong\":0"));
  const FarEnd open(false);
  const ProgramResult silent = run_program({"selftest", "--serial", open.port()});
  EXPECT_EQ(silent.exit_code, 4);
  EXPECT_THAT(silent.err, HasSubstr("nothing came back"));
}

}  // namespace
}  // namespace forager::tools
