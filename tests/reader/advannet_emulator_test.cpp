// The driver against an emulated reader that was written from the same description of the wire and shares no
// code with it: what the air delivers must come out, whatever happens on the way.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <set>

#include "mocks/sim_http_client.hpp"
#include "mocks/sim_reader.hpp"
#include "tests/reader/advannet_rig.hpp"

namespace forager::reader {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

// Tags that answer one after the other, every 20 ms while the radio is on; tag n at the n-th time.
class FakeTagField final : public mocks::TagField {
 public:
  void radio_on(const mocks::RadioSettings& settings, hal::Instant now) override {
    radio = settings;
    on = true;
    last_ = now;
  }
  void radio_off(hal::Instant) override { on = false; }
  void advance(hal::Instant now, std::vector<mocks::AirRead>& out) override {
    for (; on && last_ + 20ms <= now; last_ += 20ms) {
      epcs_.push_back(fmt::format("3034257bf7194e40{:08x}", epcs_.size()));
      out.push_back({static_cast<std::uint32_t>(epcs_.size() - 1), 1 + static_cast<int>(epcs_.size() % 2),
                     -60, 45, 866300, last_ + 20ms});
      at.push_back(last_ + 20ms);
    }
  }
  const std::string& epc_hex(std::uint32_t tag) const override { return epcs_[tag]; }

  std::optional<mocks::RadioSettings> radio;
  bool on = false;
  std::vector<hal::Instant> at;  // when tag n was read
  [[nodiscard]] const std::vector<std::string>& epcs() const { return epcs_; }

 private:
  hal::Instant last_;
  std::vector<std::string> epcs_;
};

struct EmulatedRig {
  explicit EmulatedRig(mocks::SimReaderConfig config = {}, std::string password = "admin")
      : reader(std::move(config), field, journal),
        http({"192.168.1.50:3161", 4ms, "admin", std::move(password)}, reader),
        wire("tcp 192.168.1.50:3177", mocks::MemoryStreamKind::bytes, 1U << 18U),
        driver(http, wire.near(), journal, test::rig_plan(), test::rig_config()) {
    reader.streams().attach(wire);
  }
  void run(hal::Duration length) {
    for (const hal::Instant end = now + length; now < end;) {
      now += 10ms;
      reader.update(now);
      driver.update(now);
      for (const TagRead& read : driver.reads()) {
        ++count;
        heard.insert(read.epc.hex());
        worst = std::max(worst, lag(read));
      }
    }
  }
  // How far `heard` is from the truth.
  hal::Duration lag(const TagRead& read) {
    const auto n = static_cast<std::size_t>(std::stoul(read.epc.hex().substr(16), nullptr, 16));
    const hal::Duration off = read.heard - field.at.at(n);
    return off < 0ns ? -off : off;
  }

  FakeTagField field;
  mocks::TextJournal journal;
  mocks::SimReader reader;
  mocks::SimHttpClient http;
  mocks::MemoryStreamPair wire;
  AdvanNetReader driver;
  hal::Instant now{7s};
  std::set<std::string> heard;
  std::size_t count = 0;
  hal::Duration worst{};
};

TEST(AdvanNetEmulator, PlanReachesTheAirAndEveryReadComesBack) {
  EmulatedRig rig;
  rig.driver.start(rig.now);
  rig.run(60s);
  ASSERT_EQ(rig.driver.link().phase, LinkPhase::open) << rig.driver.link().reason;
  ASSERT_TRUE(rig.field.radio);
  EXPECT_EQ(rig.field.radio->session, 1);
  EXPECT_EQ(rig.field.radio->target, 'A');
  EXPECT_EQ(rig.field.radio->q, -1);
  EXPECT_EQ(rig.field.radio->on_time, hal::Duration(600ms));
  ASSERT_EQ(rig.field.radio->ports.size(), 2U);
  EXPECT_EQ(rig.field.radio->ports[1].port, 2);
  EXPECT_EQ(rig.field.radio->ports[1].power_dbm, 30.0);
  EXPECT_EQ(rig.field.radio->ports[1].sensitivity_dbm, -70.0);
  rig.driver.stop(rig.now);
  rig.run(1s);
  EXPECT_FALSE(rig.field.on);
  EXPECT_GT(rig.field.epcs().size(), 2900U);
  // The last batch may still lie in the reader when it is stopped.
  EXPECT_GE(rig.heard.size() + 5, rig.field.epcs().size());
  EXPECT_EQ(rig.count, rig.heard.size());
  EXPECT_LE(rig.worst, hal::Duration(15ms));
  EXPECT_EQ(rig.driver.counters().malformed, 0U);
  EXPECT_EQ(rig.driver.stream_counters().garbage_lines, 0U);
}

struct Weather {
  const char* name;
  std::function<void(mocks::SimReaderConfig&)> brew;
};
class BadWeather : public ::testing::TestWithParam<Weather> {};

TEST_P(BadWeather, CostsNoReadWhileTheConnectionHolds) {
  mocks::SimReaderConfig config;
  GetParam().brew(config);
  EmulatedRig rig(config);
  rig.driver.start(rig.now);
  rig.run(60s);
  ASSERT_EQ(rig.driver.link().phase, LinkPhase::open) << rig.driver.link().reason;
  rig.field.on = false;
  rig.run(5s);
  std::set<std::string> missing;
  for (std::size_t n = 0; n < rig.field.at.size(); ++n)  // what a reader read before our start is not ours
    if (rig.field.at[n] > rig.driver.link().since) missing.insert(rig.field.epcs()[n]);
  for (const auto& epc : rig.heard) missing.erase(epc);
  EXPECT_TRUE(missing.empty()) << missing.size() << " of " << rig.field.epcs().size();
  // Folded reads carry two times 7 ms apart; a stamp lies somewhere within the exchange that brought it.
  EXPECT_LE(rig.worst, hal::Duration(25ms) + rig.reader.config().faults.rest_delay / 2);
  EXPECT_EQ(rig.driver.counters().malformed, 0U);
  EXPECT_EQ(rig.driver.link().losses, 0U);
}

INSTANTIATE_TEST_SUITE_P(
    AdvanNetEmulator, BadWeather,
    ::testing::Values(Weather{"split", [](auto& c) { c.faults.split_frame = 0.5; }},
                      Weather{"joined", [](auto& c) { c.faults.join_frame = 0.5; }},
                      Weather{"garbage", [](auto& c) { c.faults.garbage_lines = 0.5; }},
                      Weather{"old_header",
                              [](auto& c) {
                                c.faults.header_1_0 = true;
                                c.faults.bare_keep_alive = true;
                              }},
                      Weather{"disorder", [](auto& c) { c.faults.out_of_order = 0.3; }},
                      Weather{"folded", [](auto& c) { c.faults.comma_props = 0.5; }},
                      Weather{"upper_case", [](auto& c) { c.faults.upper_case_epc = true; }},
                      Weather{"duplicates", [](auto& c) { c.faults.duplicate = 0.5; }},
                      Weather{"year_2016", [](auto& c) { c.clock_at_boot_ms = mocks::kOldReaderClockMs; }},
                      Weather{"drift", [](auto& c) { c.clock_drift_ppm = 120.0; }},
                      Weather{"slow_rest", [](auto& c) { c.faults.rest_delay = 300ms; }},
                      Weather{"http_500", [](auto& c) { c.faults.http_500 = 0.1; }},
                      Weather{"error_400", [](auto& c) { c.error_http_status = 400; }},
                      Weather{"digest", [](auto& c) { c.auth = mocks::SimReaderAuth::digest; }},
                      Weather{"autostart", [](auto& c) { c.autostart = true; }}),
    [](const auto& weather) { return weather.param.name; });

TEST(AdvanNetEmulator, StaleReadsOfAReaderThatRanBeforeAreDropped) {
  mocks::SimReaderConfig config;
  config.faults.stale_reads_after_start = 20;
  EmulatedRig rig(config);
  rig.driver.start(rig.now);
  rig.run(20s);
  EXPECT_EQ(rig.driver.counters().stale, 20U);
  EXPECT_LE(rig.worst, hal::Duration(15ms));
}

TEST(AdvanNetEmulator, WrongPasswordFails) {
  mocks::SimReaderConfig config;
  config.auth = mocks::SimReaderAuth::digest;
  EmulatedRig rig(config, "guess");
  rig.driver.start(rig.now);
  rig.run(10s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::failed);
  EXPECT_THAT(rig.driver.link().reason, HasSubstr("user and password"));
}

TEST(AdvanNetEmulator, RefusedOperationIsNamed) {
  mocks::SimReaderConfig config;
  config.faults.refuse_operation = "antennas";
  EmulatedRig rig(config);
  rig.driver.start(rig.now);
  rig.run(10s);
  EXPECT_NE(rig.driver.link().phase, LinkPhase::open);
  EXPECT_THAT(rig.driver.link().reason, HasSubstr("PUT antennas: answered "));
}

TEST(AdvanNetEmulator, PowerCutAndRebootHealByThemselves) {
  EmulatedRig rig;
  rig.driver.start(rig.now);
  rig.run(30s);
  rig.reader.power_cut(rig.now);
  rig.run(30s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::lost);
  EXPECT_FALSE(rig.field.on);
  rig.reader.power_on(rig.now);
  rig.run(90s);
  ASSERT_EQ(rig.driver.link().phase, LinkPhase::open) << rig.driver.link().reason;
  EXPECT_EQ(rig.field.radio->session, 1);
  EXPECT_TRUE(rig.field.on);
  rig.reader.reboot(rig.now);
  rig.run(90s);
  ASSERT_EQ(rig.driver.link().phase, LinkPhase::open) << rig.driver.link().reason;
  EXPECT_TRUE(rig.field.on);
  EXPECT_EQ(rig.driver.link().losses, 2U);
  EXPECT_EQ(rig.driver.counters().configured, 3U);
}

TEST(AdvanNetEmulator, PausesAndCutConnectionsEndInAnOpenLink) {
  mocks::SimReaderConfig config;
  config.faults.pause = 0.0005;
  config.faults.pause_length = 12s;
  config.faults.close_abruptly = 0.001;
  EmulatedRig rig(config);
  rig.driver.start(rig.now);
  rig.run(20min);
  rig.reader.faults().pause = rig.reader.faults().close_abruptly = 0.0;
  rig.run(60s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::open) << rig.driver.link().reason;
  EXPECT_GT(rig.driver.link().losses, 10U);
  EXPECT_EQ(rig.driver.counters().reconnects, rig.driver.link().losses);
  EXPECT_EQ(rig.driver.counters().configured, 1U) << "a cut stream is no reason to stop the radio";
}

TEST(AdvanNetEmulator, InputsAndOutputsWork) {
  EmulatedRig rig;
  auto& relay = rig.driver.gpo(9);
  rig.driver.start(rig.now);
  rig.run(2s);
  ASSERT_TRUE(relay.set(true));
  rig.run(200ms);
  EXPECT_TRUE(rig.reader.gpo(9));
  rig.reader.set_gpi(3, true, rig.now);
  bool seen = false;
  for (int i = 0; i < 50; ++i) {
    rig.run(10ms);
    for (const GpiEvent& event : rig.driver.inputs()) seen = event.line == 3 && event.high;
    if (seen) break;
  }
  EXPECT_TRUE(seen);
  rig.driver.halt();
  rig.run(1s);
  EXPECT_FALSE(rig.reader.gpo(9));
  EXPECT_FALSE(rig.field.on);
}

TEST(AdvanNetEmulator, EqualSeedsGiveEqualRuns) {
  std::array<std::uint64_t, 2> hashes{};
  for (auto& hash : hashes) {
    mocks::SimReaderConfig config;
    config.faults.split_frame = config.faults.garbage_lines = config.faults.out_of_order = 0.2;
    config.faults.close_abruptly = 0.002;
    config.journal_wire = true;
    EmulatedRig rig(config);
    rig.driver.start(rig.now);
    rig.run(60s);
    hash = rig.journal.hash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

}  // namespace
}  // namespace forager::reader
