#include "reader/advannet_listener.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <span>
#include <vector>

#include "mocks/memory_stream.hpp"
#include "tests/reader/advannet_rig.hpp"

namespace forager::reader {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

// An event stream with a listener at it.
class AdvanNetListenerTest : public testing::Test {
 protected:
  void run(hal::Duration length) {
    for (const hal::Instant end = now_ + length; now_ < end;) {
      now_ += 10ms;
      if (keep_alives_ && wire_.connected() && now_.time_since_epoch() % 5s < 10ms) send(test::kEmptyFrame);
      listener_.update(now_);
      reads_.insert(reads_.end(), listener_.reads().begin(), listener_.reads().end());
    }
  }
  void send(std::string_view bytes) { static_cast<void>(wire_.far().write(std::as_bytes(std::span(bytes)))); }
  void tag(std::string_view epc, std::int64_t stamp_ms) {
    send(test::advannet_frame(test::advannet_inventory(
        test::advannet_item(epc, stamp_ms, "<prop>RSSI:-60</prop><prop>ANTENNA_PORT:3</prop>"))));
  }

  mocks::TextJournal journal_;
  mocks::MemoryStreamPair wire_{"events", mocks::MemoryStreamKind::bytes, 1U << 20U};
  AdvanNetListener listener_{wire_.near(), journal_, test::rig_config()};
  hal::Instant now_{100s};
  bool keep_alives_ = true;
  std::vector<TagRead> reads_;
};

TEST_F(AdvanNetListenerTest, HearsReadsAndStampsThemOnArrivalWhateverTheReadersClockSays) {
  listener_.start(now_);
  run(100ms);
  ASSERT_EQ(listener_.link().phase, LinkPhase::open) << listener_.link().reason;
  EXPECT_FALSE(listener_.link().reading());
  tag("bd01fac6", 1);  // 1970
  run(10ms);
  ASSERT_EQ(reads_.size(), 1U);
  EXPECT_EQ(reads_[0].port, 3);
  EXPECT_EQ(reads_[0].rssi_dbm, -60);
  EXPECT_EQ(reads_[0].heard, now_);
  EXPECT_TRUE(listener_.link().reading());
  EXPECT_EQ(listener_.counters().inventories, 1U);
}

TEST_F(AdvanNetListenerTest, SendsNotOneByte) {
  listener_.start(now_);
  run(12s);
  tag("bd01fac6", 1);
  run(12s);
  std::array<std::byte, 16> room;
  EXPECT_EQ(wire_.far().read(room).value(), 0U);
  EXPECT_EQ(listener_.link().phase, LinkPhase::open);  // keep-alives are enough
}

TEST_F(AdvanNetListenerTest, AServiceThatSpeaksSomethingElseIsToldApartFromSilence) {
  listener_.start(now_);
  keep_alives_ = false;
  run(1s);
  send("HTTP/1.1 400 Bad Request\r\n");
  run(11s);
  EXPECT_EQ(listener_.link().losses, 1U);
  EXPECT_THAT(journal_.text(), HasSubstr("only noise for"));
}

TEST_F(AdvanNetListenerTest, SilenceIsALossAndItConnectsAgain) {
  listener_.start(now_);
  run(1s);
  keep_alives_ = false;
  run(11s);
  EXPECT_EQ(listener_.link().losses, 1U);
  EXPECT_THAT(journal_.text(), HasSubstr("nothing for"));
  keep_alives_ = true;
  run(7s);
  EXPECT_TRUE(listener_.link().reading());
  EXPECT_EQ(listener_.counters().reconnects, 1U);
}

TEST_F(AdvanNetListenerTest, HaltedItHangsUpAndStaysSo) {
  listener_.start(now_);
  run(1s);
  listener_.halt();
  run(5s);
  EXPECT_EQ(listener_.link().phase, LinkPhase::closed);
  EXPECT_FALSE(wire_.connected());
}

}  // namespace
}  // namespace forager::reader
