#include "mocks/gen2_field_dwell.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;

RadioSettings four_ports() {
  RadioSettings settings;
  for (const int port : {4, 3, 1, 2}) settings.ports.push_back({port, 30.0, -80.0});
  return settings;
}

TEST(DwellSchedule, VisitsPortsInTurnOnChangingEtsiChannels) {
  DwellSchedule schedule(AirParameters{}, 1);
  schedule.start(four_ports(), 10.0);
  std::vector<double> stays;
  Dwell before = schedule.dwell();
  EXPECT_EQ(before.port_index, 0U);
  EXPECT_EQ(before.start_s, 10.0);
  for (int i = 0; i < 4000; ++i) {
    stays.push_back(before.end_s - before.start_s);
    schedule.advance();
    const Dwell& now = schedule.dwell();
    EXPECT_EQ(now.port_index, (before.port_index + 1) % 4);
    EXPECT_EQ(now.start_s, before.end_s);
    EXPECT_EQ(now.id, before.id + 1);
    EXPECT_NE(now.frequency_khz, before.frequency_khz);
    EXPECT_EQ((now.frequency_khz - 865700) % 600, 0U);
    EXPECT_LE(now.frequency_khz, 867500U);
    before = now;
  }
  // Nobody answers: the median visit is the median patience.
  std::nth_element(stays.begin(), stays.begin() + 2000, stays.end());
  EXPECT_NEAR(stays[2000], 0.019, 0.0015);
}

TEST(DwellSchedule, StaysWhileNewTagsAnswerButNotForEver) {
  AirParameters air;
  air.patience_log_sigma = 0.0;
  DwellSchedule schedule(air, 1);
  schedule.start(four_ports(), 0.0);
  EXPECT_NEAR(schedule.dwell().end_s, 0.019, 1e-12);
  schedule.prolong(0.015);
  EXPECT_NEAR(schedule.dwell().end_s, 0.033, 1e-12);
  for (double t = 0.02; t < 5.0; t += 0.01) schedule.prolong(t);
  EXPECT_EQ(schedule.dwell().end_s, air.max_dwell_s);
}

TEST(DwellSchedule, KeepsTheDutyCycle) {
  RadioSettings settings = four_ports();
  settings.on_time = 100ms;
  settings.off_time = 200ms;
  DwellSchedule schedule(AirParameters{}, 1);
  schedule.start(settings, 0.0);
  double on = 0.0;
  while (schedule.dwell().end_s < 300.0) {
    const Dwell& d = schedule.dwell();
    on += d.end_s - d.start_s;
    const double in_cycle = std::fmod(d.start_s + 1e-9, 0.3);
    EXPECT_LT(in_cycle, 0.1) << d.start_s;
    schedule.advance();
  }
  EXPECT_NEAR(on, 100.0, 0.5);
}

}  // namespace
}  // namespace forager::mocks
