// A day of links that come and go: every one must be up again in bounded time, say why it was not, keep its
// ages right, and give back what it used.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cstdio>

#include "hal/random.hpp"
#include "tests/boards/flapping_links.hpp"

namespace forager::boards {
namespace {

using namespace test_links;

constexpr hal::Duration kDay = 24h;
constexpr hal::Duration kTick = 100ms;

struct Flapping {
  int faults = 0;
  int noticed = 0;
  hal::Duration slowest{};
  std::size_t early_bytes = 0;
  std::size_t late_bytes = 0;
};

// Faults of 1 to 60 s, of a kind drawn by lot, until the day is over; up for 1 to 120 s in between once it
// has recovered.
Flapping a_day_of(Link& link, std::uint64_t seed) {
  Flapping day;
  hal::Random random(seed);
  const auto seconds = [&](double from, double to) { return hal::from_seconds(random.uniform(from, to)); };
  hal::Instant now;
  const auto live = [&](hal::Duration time) {
    for (const hal::Instant end = now + time; now < end;) link.update(now += kTick);
  };
  const auto wait_until_up = [&] {
    const hal::Instant start = now;
    while (!link.up(now) && now - start <= link.recovers_within) link.update(now += kTick);
    EXPECT_TRUE(link.up(now)) << "still down " << hal::to_seconds(now - start) << " s after the mend, at "
                              << hal::to_seconds(now) << " s: " << link.reason();
    return now - start;
  };
  wait_until_up();
  while (now < hal::Instant{} + kDay && !testing::Test::HasFailure()) {
    live(seconds(1.0, 120.0));
    const hal::Duration length = seconds(1.0, 60.0);
    const hal::Instant broken = now;
    link.break_down(random.below(4), now);
    ++day.faults;
    live(length);
    if (length > link.notices_within + 1s) {
      EXPECT_FALSE(link.up(now)) << "nobody noticed for " << hal::to_seconds(length) << " s";
      EXPECT_FALSE(link.reason().empty());
      EXPECT_TRUE(!link.deaf || link.last_heard() <= broken + 2 * kTick) << "heard from the dead";
      ++day.noticed;
    }
    link.mend(now);
    day.slowest = std::max(day.slowest, wait_until_up());
    EXPECT_GE(link.last_heard(), broken - 60s);
    if (day.faults == 60) day.early_bytes = ::mallinfo2().uordblks;
  }
  day.late_bytes = ::mallinfo2().uordblks;
  return day;
}

void expect_a_good_day(Link& link, std::uint64_t seed, const char* name) {
  const Flapping day = a_day_of(link, seed);
  testing::Test::RecordProperty(name, day.faults);
  std::printf("[  links   ] %s: %d faults, %d long enough to notice, slowest recovery %.1f s, %+ld bytes\n",
              name, day.faults, day.noticed, hal::to_seconds(day.slowest),
              static_cast<long>(day.late_bytes) - static_cast<long>(day.early_bytes));
  EXPECT_GT(day.faults, 300);
  EXPECT_GT(day.noticed, 150);
  EXPECT_LT(day.late_bytes, day.early_bytes + 64 * 1024) << "memory grows with every fault";
}

TEST(LinkFlap, ReaderIsBackAfterEveryFaultOfADay) {
  ReaderLink link;
  expect_a_good_day(link, 1, "reader");
}

TEST(LinkFlap, AutopilotOnDatagramsIsBackAfterEveryFaultOfADay) {
  DatagramLink link;
  expect_a_good_day(link, 2, "mavlink");
}

TEST(LinkFlap, AutopilotOnASerialPortIsBackAfterEveryFaultOfADay) {
  SerialLink link;
  expect_a_good_day(link, 3, "serial");
}

TEST(LinkFlap, ModbusDevicesAreBackAfterEveryFaultOfADay) {
  ModbusLink link;
  expect_a_good_day(link, 4, "modbus");
}

}  // namespace
}  // namespace forager::boards
