#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "mocks/text_journal.hpp"
#include "reader/advannet_reader.hpp"
#include "tests/reader/advannet_sample.hpp"
#include "tests/reader/fake_advannet.hpp"

namespace forager::test {

inline constexpr std::string_view kEmptyFrame =
    "ADVANNET/1.1\r\nContent-Length:0\r\nContent-Type:text/xml\r\n\r\n\r\n\r\n";

[[nodiscard]] inline reader::ReadPlan rig_plan() {
  reader::ReadPlan plan;
  plan.session = reader::Session::s1;
  plan.power_dbm = 30.0;
  plan.sensitivity_dbm = -70.0;
  plan.on_time = std::chrono::milliseconds(600);
  plan.ports = {{1, "front", 0.0, 30.0, -70.0}, {2, "left", 1.5708, {}, {}}};
  return plan;
}

[[nodiscard]] inline reader::AdvanNetConfig rig_config() {
  using namespace std::chrono_literals;
  reader::AdvanNetConfig config;
  config.request_timeout = 2s;
  config.stream_timeout = 10s;
  config.status_period = 10s;
  config.backoff_first = 1s;
  config.backoff_cap = 60s;
  return config;
}

// A driver, a fake reader and time.
struct AdvanNetRig {
  explicit AdvanNetRig(reader::AdvanNetConfig config = rig_config(), reader::ReadPlan plan = rig_plan())
      : driver(fake, fake.wire.near(), journal, std::move(plan), std::move(config)) {}

  FakeAdvanNet fake;
  mocks::TextJournal journal;
  reader::AdvanNetReader driver;
  hal::Instant now{std::chrono::seconds(100)};
  hal::Duration tick = std::chrono::milliseconds(10);
  bool keep_alives = true;
  std::vector<reader::TagRead> reads;  // all so far
  std::vector<reader::GpiEvent> inputs;

  // Lets time pass, with keep-alives every 5 s while the fake is up.
  void run(hal::Duration length) {
    for (const hal::Instant end = now + length; now < end;) {
      now += tick;
      if (keep_alives && !fake.down && !fake.silent &&
          now.time_since_epoch() % std::chrono::seconds(5) < tick)
        fake.send(kEmptyFrame);
      driver.update(now);
      reads.insert(reads.end(), driver.reads().begin(), driver.reads().end());
      inputs.insert(inputs.end(), driver.inputs().begin(), driver.inputs().end());
    }
  }
  void open() {
    driver.start(now);
    for (int i = 0; i < 10 && driver.link().phase != reader::LinkPhase::open; ++i) run(5 * tick);
    ASSERT_EQ(driver.link().phase, reader::LinkPhase::open) << driver.link().reason;
  }
  // The fake reads a tag, its clock being off by `late`.
  void read(std::string_view epc, hal::Duration late = {}) {
    const auto stamp = fake.ms(now) - late / std::chrono::milliseconds(1);
    fake.send(advannet_frame(
        advannet_inventory(advannet_item(epc, stamp, "<prop>RSSI:-60</prop><prop>ANTENNA_PORT:1</prop>"))));
  }
};

}  // namespace forager::test
