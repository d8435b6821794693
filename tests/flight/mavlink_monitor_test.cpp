#include "flight/mavlink_monitor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

#include "flight/mavlink/codec.hpp"
#include "flight/mavlink/messages.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class MonitorTest : public testing::Test {
 protected:
  template <mavlink::Message M>
  std::optional<std::string> hear(const M& message, hal::Instant at, mavlink::Sender& sender) {
    mavlink::FrameBuffer buffer;
    std::optional<std::string> text;
    parser_.feed(mavlink::encode(message, sender, buffer),
                 [&](const mavlink::Frame& frame) { text = monitor_.take(frame, at); });
    return text;
  }
  static mavlink::Heartbeat copter(std::uint32_t mode, bool armed) {
    mavlink::Heartbeat heartbeat;
    heartbeat.type = mavlink::vehicle_type::kHexarotor;
    heartbeat.autopilot = mavlink::autopilot_type::kArdupilot;
    heartbeat.custom_mode = mode;
    heartbeat.base_mode = armed ? mavlink::mode_flag::kSafetyArmed : 0;
    return heartbeat;
  }
  mavlink::Parser parser_;
  MavlinkMonitor monitor_;
  mavlink::Sender vehicle_{1, 1, 0};
  mavlink::Sender station_{255, 190, 0};
};

TEST_F(MonitorTest, KeepsWhoSaidWhatHowOften) {
  hear(copter(4, false), hal::Instant(1s), vehicle_);
  hear(mavlink::Attitude{}, hal::Instant(1s), vehicle_);
  hear(mavlink::Attitude{}, hal::Instant(2s), vehicle_);
  mavlink::Heartbeat station;
  station.autopilot = mavlink::autopilot_type::kInvalid;
  hear(station, hal::Instant(2s), station_);
  ASSERT_EQ(monitor_.traffic().size(), 3U);
  EXPECT_EQ(monitor_.traffic()[0].name, "HEARTBEAT");
  EXPECT_EQ(monitor_.traffic()[1].name, "ATTITUDE");
  EXPECT_EQ(monitor_.traffic()[1].frames, 2U);
  EXPECT_EQ(monitor_.traffic()[1].last, hal::Instant(2s));
  EXPECT_EQ(monitor_.traffic()[2].sysid, 255);
  EXPECT_EQ(monitor_.interval_frames(), 4U);
  monitor_.next_interval();
  EXPECT_EQ(monitor_.interval_frames(), 0U);
  EXPECT_EQ(monitor_.traffic()[1].interval_frames, 0U);
  EXPECT_EQ(monitor_.traffic()[1].frames, 2U);
  ASSERT_NE(monitor_.autopilot(), nullptr);
  EXPECT_EQ(monitor_.autopilot()->sysid, 1);
}

TEST_F(MonitorTest, AStationAloneIsNoAutopilot) {
  mavlink::Heartbeat station;
  station.autopilot = mavlink::autopilot_type::kInvalid;
  hear(station, hal::Instant(1s), station_);
  EXPECT_EQ(monitor_.autopilot(), nullptr);
}

TEST_F(MonitorTest, TheBatteryIsThatOfItsComponent) {
  hear(copter(4, true), hal::Instant(1s), vehicle_);
  mavlink::SysStatus status;
  status.voltage_battery = 15'800;
  status.battery_remaining = 83;
  hear(status, hal::Instant(1s), vehicle_);
  EXPECT_EQ(monitor_.autopilot()->battery_percent, 83);
  EXPECT_EQ(monitor_.autopilot()->battery_volts, 15.8);
  status.voltage_battery = 0xFFFF;  // it does not know
  status.battery_remaining = -1;
  hear(status, hal::Instant(2s), vehicle_);
  EXPECT_EQ(monitor_.autopilot()->battery_percent, 83);
}

TEST_F(MonitorTest, TextsAreHandedOut) {
  mavlink::Statustext text;
  text.severity = 4;
  std::ranges::copy(std::string_view("PreArm: no"), text.text.begin());
  EXPECT_EQ(hear(text, hal::Instant(1s), vehicle_), "[4] PreArm: no");
  EXPECT_EQ(hear(copter(0, false), hal::Instant(1s), vehicle_), std::nullopt);
}

TEST(MavlinkWords, NamesAreThoseOfTheAutopilot) {
  mavlink::Heartbeat heartbeat;
  heartbeat.type = mavlink::vehicle_type::kQuadrotor;
  heartbeat.autopilot = mavlink::autopilot_type::kArdupilot;
  heartbeat.custom_mode = 20;
  EXPECT_EQ(mode_text(heartbeat), "GUIDED_NOGPS");
  heartbeat.custom_mode = 99;
  EXPECT_EQ(mode_text(heartbeat), "mode 99");
  heartbeat.custom_mode = 4;
  heartbeat.autopilot = mavlink::autopilot_type::kPx4;  // counts its modes otherwise
  EXPECT_EQ(mode_text(heartbeat), "mode 4");
  EXPECT_EQ(vehicle_text(13), "hexarotor");
  EXPECT_EQ(vehicle_text(200), "type 200");
  EXPECT_EQ(autopilot_text(8), "no autopilot");
}

TEST(MavlinkSilenceText, TellsTheCausesApart) {
  MavlinkSilence facts;
  facts.link_problem = "no such port";
  EXPECT_EQ(why_silent(facts), "the link is down: no such port");
  facts.link_open = true;
  EXPECT_THAT(why_silent(facts), HasSubstr("another address or port"));
  facts.serial = true;
  EXPECT_THAT(why_silent(facts), HasSubstr("RX and TX"));
  facts.parser.bytes = 800;
  EXPECT_THAT(why_silent(facts), HasSubstr("another baud rate"));
  facts.parser.bad_crc = 4;
  EXPECT_THAT(why_silent(facts), HasSubstr("checksum"));
  facts.parser.frames = 10;
  EXPECT_THAT(why_silent(facts), HasSubstr("no heartbeat of an autopilot"));
  facts.autopilot_heard = true;
  EXPECT_THAT(why_silent(facts), HasSubstr("fallen silent"));
}

}  // namespace
}  // namespace forager::flight
