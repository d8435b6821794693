// MAVLink over a serial port that the board file names, to the emulated autopilot at its other end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "boards/autopilot_line.hpp"
#include "boards/emulate.hpp"
#include "boards/scene.hpp"
#include "flight/mavlink_autopilot.hpp"
#include "flight/motor_authority.hpp"
#include "mocks/text_journal.hpp"
#include "tests/places.hpp"
#include "tests/scratch_folder.hpp"

namespace forager::boards {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class SerialAutopilotTest : public testing::Test {
 protected:
  SerialAutopilotTest() {
    const auto board = load_board(folder_.write(
        "board.toml", "[board]\nname = \"bench\"\n[autopilot]\nserial = \"" + port_ + "\"\nbaud = 921600\n"));
    line_ = open_autopilot_line(board.value());
    driver_ = flight::MavlinkAutopilot::create(*line_, journal_, {}, now_, *bay_.claim("test")).value();
  }
  hal::Result<> plug_in() {
    EmulatedAutopilotOptions options;
    options.serial = port_;
    auto server = emulate_autopilot(scene_, options, journal_);
    if (!server) return hal::fail(std::move(server).error());
    server_ = *std::move(server);
    return {};
  }
  // Simulated seconds at the pace a real terminal allows: its bytes take a moment.
  template <class Condition>
  bool within(hal::Duration time, Condition condition) {
    for (const hal::Instant end = now_ + time; now_ < end && !condition(); now_ += 20ms) {
      if (server_) server_->update(now_);
      driver_->feed_deadman(now_);
      driver_->update(now_);
      std::this_thread::sleep_for(100us);
    }
    return condition();
  }
  [[nodiscard]] bool up() const { return driver_->state().link_up; }

  test::ScratchFolder folder_;
  std::string port_ = folder_.file("pixhawk");
  Scene scene_ = load_scene(test::source_path("scenes/3A.toml")).value();
  mocks::TextJournal journal_;
  flight::MotorBay bay_;
  hal::Instant now_{1s};
  std::unique_ptr<EmulatedServer> server_;
  std::unique_ptr<hal::ByteStream> line_;
  std::unique_ptr<flight::MavlinkAutopilot> driver_;
};

TEST_F(SerialAutopilotTest, TalksAndComesBackWhenTheCableWasOut) {
  ASSERT_FALSE(within(2s, [&] { return up(); }));
  EXPECT_THAT(journal_.text(), HasSubstr("there is no such port"));
  ASSERT_TRUE(plug_in());
  EXPECT_THAT(server_->address(), HasSubstr(port_));
  ASSERT_TRUE(within(20s, [&] { return up(); }));
  EXPECT_TRUE(within(10s, [&] { return driver_->state().battery_fraction.has_value(); }))
      << "what it was asked for it sends";
  server_.reset();
  EXPECT_TRUE(within(10s, [&] { return !up(); }));
  EXPECT_THAT(journal_.text(), HasSubstr("the adapter was unplugged"));
  ASSERT_TRUE(plug_in());
  EXPECT_TRUE(within(20s, [&] { return up(); }));
}

}  // namespace
}  // namespace forager::boards
