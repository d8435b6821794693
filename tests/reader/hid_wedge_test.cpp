#include "reader/hid_wedge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mocks/fake_hid.hpp"
#include "mocks/sim_hid_echo.hpp"
#include "mocks/sim_wedge.hpp"

namespace forager::reader {
namespace {

using namespace std::chrono_literals;
using hal::Instant;
using testing::HasSubstr;

class HidWedgeTest : public testing::Test {
 protected:
  std::vector<std::string> update(hal::Duration after) {
    now_ += after;
    wedge_.update(now_);
    std::vector<std::string> hex;
    for (const TagRead& read : wedge_.reads()) hex.push_back(read.epc.hex());
    return hex;
  }
  mocks::SimWedge keyboard_;
  mocks::FakeHid hid_;
  HidWedge wedge_{hid_, {}};
  Instant now_{1s};
};
using Words = std::vector<std::string>;

TEST_F(HidWedgeTest, TagsComeOnceEachWithTheTimeTheyWereHeard) {
  hid_.plug(keyboard_);
  wedge_.start(now_);
  ASSERT_EQ(LinkPhase::open, wedge_.link().phase);
  keyboard_.read_tag("30349bb6000000000000002a");
  keyboard_.read_tag("30349bb6000000000000002b");
  EXPECT_EQ((Words{"30349bb6000000000000002a", "30349bb6000000000000002b"}), update(20ms));
  const TagRead& read = wedge_.reads().front();
  EXPECT_EQ(now_, read.heard);
  EXPECT_EQ(TagRead::kNoRssi, read.rssi_dbm);
  EXPECT_EQ(0, read.port);
  EXPECT_TRUE(update(20ms).empty());
  EXPECT_EQ(Instant(1s + 20ms), wedge_.link().last_heard);
}

TEST_F(HidWedgeTest, NothingItTypesReachesAConsole) {
  hid_.plug(keyboard_);
  wedge_.start(now_);
  keyboard_.read_tag("beef");
  EXPECT_EQ(Words{"beef"}, update(20ms));
  EXPECT_EQ(0U, hid_.leaked(keyboard_));
  HidWedge second(hid_, {});
  second.start(now_);
  EXPECT_EQ(LinkPhase::lost, second.link().phase);
  EXPECT_THAT(second.link().reason, HasSubstr("for itself"));
}

TEST_F(HidWedgeTest, UnpluggedItIsLostWithAReasonAndComesBackByItself) {
  wedge_.start(now_);
  EXPECT_EQ(LinkPhase::lost, wedge_.link().phase);
  EXPECT_THAT(wedge_.link().reason, HasSubstr("no such device"));
  hid_.plug(keyboard_);
  for (int i = 0; i < 20; ++i) update(20ms);
  ASSERT_EQ(LinkPhase::open, wedge_.link().phase);
  keyboard_.type("be");
  update(20ms);
  hid_.unplug(keyboard_);
  update(20ms);
  EXPECT_EQ(LinkPhase::lost, wedge_.link().phase);
  EXPECT_EQ(1U, wedge_.link().losses);
  hid_.plug(keyboard_);
  for (int i = 0; i < 20; ++i) update(20ms);
  keyboard_.read_tag("cafe");
  EXPECT_EQ(Words{"cafe"}, update(20ms)) << "half a word from before the loss is forgotten";
}

TEST_F(HidWedgeTest, APauseEndsAnEpcWithoutAnEnd) {
  hid_.plug(keyboard_);
  wedge_.start(now_);
  keyboard_.type("beef");
  EXPECT_TRUE(update(20ms).empty());
  EXPECT_TRUE(update(100ms).empty());
  EXPECT_EQ(Words{"beef"}, update(100ms));
  EXPECT_TRUE(update(300ms).empty());
}

TEST_F(HidWedgeTest, OtherDevicesAreNoKeyboardsAndHaltLetsGo) {
  mocks::SimHidEcho other("/dev/hidraw0");
  hid_.plug(other);
  hid_.plug(keyboard_);
  wedge_.start(now_);
  ASSERT_EQ(LinkPhase::open, wedge_.link().phase);
  wedge_.halt();
  EXPECT_EQ(LinkPhase::closed, wedge_.link().phase);
  keyboard_.read_tag("beef");
  EXPECT_TRUE(update(20ms).empty());
  HidWedge second(hid_, {});
  second.start(now_);
  EXPECT_EQ(LinkPhase::open, second.link().phase) << "the first one has given the keyboard back";
}

}  // namespace
}  // namespace forager::reader
