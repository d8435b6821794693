// Every fault switch of the emulated reader must be visible to a client.
#include <gmock/gmock.h>

#include <algorithm>
#include <vector>

#include "mocks/sim_http_client.hpp"
#include "tests/mocks/sim_reader_bench.hpp"

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// A running reader with one client that hears reads at even spacing from 0.1 s on.
struct RunningBench : SimReaderBench {
  explicit RunningBench(const SimReaderFaults& faults, int reads = 20, double spacing_s = 0.1)
      : SimReaderBench(config_with(faults)) {
    reader.streams().attach(line);
    dial();
    run_until(0.005);
    const auto tag = field.add_tag("30aabb01");
    for (int k = 0; k < reads; ++k) reply(tag, 0.1 + spacing_s * k);
    device_get("start");
  }
  static SimReaderConfig config_with(const SimReaderFaults& faults) {
    SimReaderConfig config;
    config.faults = faults;
    return config;
  }
  // Times of all items in the order they came, milliseconds after power-up.
  [[nodiscard]] std::vector<long> item_times() const {
    std::vector<long> times;
    constexpr std::string_view kMark = "TIME_STAMP:1779868";
    for (std::size_t at = heard.find(kMark); at != std::string::npos; at = heard.find(kMark, at + 1))
      times.push_back(std::stol(heard.substr(at + kMark.size(), 6)) - 340'000);
    return times;
  }
};

TEST(SimReaderFaultSwitches, NoFaultsGiveEveryReadOnceInOrder) {
  RunningBench bench({});
  bench.run_until(4.0);
  const auto times = bench.item_times();
  EXPECT_EQ(times.size(), 20U);
  EXPECT_TRUE(std::ranges::is_sorted(times));
}

TEST(SimReaderFaultSwitches, SplitFramesArriveInPieces) {
  RunningBench bench({.split_frame = 1.0}, 1);
  std::size_t pieces = 0;
  std::size_t before = 0;
  while (bench.now < SimReaderBench::at(2.0)) {
    bench.run_until(hal::to_seconds(bench.now) + 0.005);
    if (bench.heard.size() > before) ++pieces;
    before = bench.heard.size();
  }
  EXPECT_GT(pieces, 2U);
  EXPECT_EQ(bench.item_times().size(), 1U);
  EXPECT_THAT(bench.heard, testing::EndsWith("</inventory>\r\n\r\n"));
}

TEST(SimReaderFaultSwitches, JoinedFramesComeAtOnce) {
  RunningBench bench({.join_frame = 1.0}, 4);
  bench.run_until(0.15);
  EXPECT_EQ(bench.heard, "");
  bench.run_until(0.25);
  EXPECT_EQ(occurrences(bench.heard, "ADVANNET"), 2);
  bench.run_until(3.0);
  EXPECT_EQ(bench.item_times().size(), 4U);
}

TEST(SimReaderFaultSwitches, GarbageLinesComeBetweenWholeFrames) {
  RunningBench bench({.garbage_lines = 1.0}, 3);
  bench.run_until(1.0);
  EXPECT_EQ(bench.item_times().size(), 3U);
  EXPECT_GE(occurrences(bench.heard, "?"), 3 + 2 * 3) << "xml declarations have two each";
  EXPECT_THAT(bench.heard, testing::StartsWith("?"));
}

TEST(SimReaderFaultSwitches, APauseIsLongerThanAnyKeepAlive) {
  RunningBench bench({}, 3);
  bench.run_until(0.15);
  const auto before = bench.heard.size();
  bench.reader.faults().pause = 1.0;
  bench.run_until(0.25);
  bench.reader.faults().pause = 0.0;
  bench.run_until(9.1);
  EXPECT_EQ(bench.heard.size(), before);
  bench.run_until(9.3);
  EXPECT_EQ(bench.item_times().size(), 3U);
}

TEST(SimReaderFaultSwitches, AnAbruptCloseLeavesHalfAFrame) {
  RunningBench bench({.close_abruptly = 1.0}, 1);
  bench.run_until(0.2);
  EXPECT_EQ(bench.line.near().state(), hal::StreamState::closed);
  EXPECT_THAT(bench.heard, Not(HasSubstr("</inventory>\r\n\r\n")));
  EXPECT_FALSE(bench.heard.empty());
  EXPECT_TRUE(bench.dial()) << "and the reader listens again";
}

TEST(SimReaderFaultSwitches, OldHeadersAndBareKeepAlives) {
  RunningBench bench({.header_1_0 = true, .bare_keep_alive = true}, 1);
  bench.run_until(6.0);
  EXPECT_THAT(bench.heard, testing::StartsWith("ADVANNET/1.0\r\nContent-Length:"));
  EXPECT_THAT(bench.heard, testing::EndsWith("ADVANNET/1.0\r\nContent-Length:0\r\n\r\n\r\n\r\n"));
}

TEST(SimReaderFaultSwitches, StaleReadsCarryTimesBeforeTheStart) {
  RunningBench bench({.stale_reads_after_start = 3}, 10);
  bench.run_until(3.0);
  const auto times = bench.item_times();
  EXPECT_EQ(times.size(), 13U);
  EXPECT_EQ(std::ranges::count_if(times, [](long t) { return t < 0; }), 3);
}

TEST(SimReaderFaultSwitches, OutOfOrderReadsAreLateByAtMostWhatWasSeen) {
  RunningBench bench({.out_of_order = 0.5}, 200, 0.05);
  bench.run_until(14.0);
  const auto times = bench.item_times();
  EXPECT_EQ(times.size(), 200U);
  long worst = 0;
  long latest = 0;
  for (const long t : times) {
    latest = std::max(latest, t);
    worst = std::max(worst, latest - t);
  }
  EXPECT_GT(worst, 1000);
  EXPECT_LE(worst, 1700 + 150);
}

TEST(SimReaderFaultSwitches, DuplicatesCommasAndUpperCase) {
  RunningBench bench({.duplicate = 1.0, .comma_props = 1.0, .upper_case_epc = true}, 1);
  bench.run_until(1.0);
  EXPECT_EQ(bench.item_times().size(), 2U);
  EXPECT_THAT(bench.heard, HasSubstr("<prop>RSSI:-60,-63</prop>"));
  EXPECT_THAT(bench.heard, HasSubstr("<prop>ANTENNA_PORT:1,1</prop>"));
  EXPECT_THAT(bench.heard, HasSubstr("<epc>30AABB01</epc>"));
  EXPECT_THAT(bench.heard, Not(HasSubstr("30aabb01")));
}

TEST(SimReaderFaultSwitches, TheClockStartsWrong) {
  RunningBench bench({.clock_at_boot_ms = kOldReaderClockMs}, 1);
  bench.run_until(1.0);
  EXPECT_THAT(bench.heard, HasSubstr("<prop>TIME_STAMP:1455213225095</prop>"));
}

// --- REST and the in-process client ------------------------------------------------------------------

struct Asking : testing::Test {
  hal::Result<std::optional<hal::HttpResponse>> ask(std::string_view path, double seconds = 10.0) {
    hal::HttpRequest request;
    request.path = path;
    request.timeout = 5s;
    const auto started = client.start(request, bench.now);
    if (!started) return hal::fail(started.error());
    const auto end = bench.now + hal::from_seconds(seconds);
    while (true) {
      auto answer = client.poll(bench.now);
      if (!answer || *answer || bench.now >= end) return answer;
      bench.run_until(hal::to_seconds(bench.now) + 0.01);
    }
  }
  hal::ErrorCode failure(std::string_view path) {
    const auto answer = ask(path);
    EXPECT_FALSE(answer.has_value()) << path;
    return answer ? hal::ErrorCode::io : answer.error().code;
  }
  SimReaderBench bench;
  SimHttpClient client{{}, bench.reader};
};

TEST_F(Asking, AnswersComeAfterTheLatencyAndNotBefore) {
  client.set_latency(30ms);
  const auto answer = ask("/devices");
  ASSERT_TRUE(answer && *answer);
  EXPECT_EQ((*answer)->status, 200);
  EXPECT_THAT((*answer)->body, HasSubstr("<id>AdvanReader-m4-160</id>"));
  EXPECT_EQ(bench.now, SimReaderBench::at(0.03));
}

TEST_F(Asking, ASlowReaderWorksOffRequestsOneByOne) {
  bench.reader.faults().rest_delay = 2s;
  SimHttpClient second{{}, bench.reader};
  hal::HttpRequest request;
  request.path = "/status";
  request.timeout = 10s;
  ASSERT_TRUE(second.start(request, bench.now).has_value());
  const auto answer = ask("/devices");
  ASSERT_TRUE(answer && *answer);
  EXPECT_EQ(bench.now, SimReaderBench::at(4.0));
  bench.reader.faults().rest_delay = 6s;
  EXPECT_EQ(failure("/devices"), hal::ErrorCode::timeout);
}

TEST_F(Asking, ANamedOperationIsRefusedSoManyTimes) {
  bench.reader.faults().refuse_operation = "start";
  bench.reader.faults().refuse_times = 2;
  const std::string start = "/devices/AdvanReader-m4-160/start";
  for (int k = 0; k < 2; ++k) {
    const auto answer = ask(start);
    ASSERT_TRUE(answer && *answer);
    EXPECT_THAT((*answer)->body, HasSubstr("<status>ERROR</status>"));
  }
  EXPECT_FALSE(bench.field.on());
  const auto answer = ask(start);
  ASSERT_TRUE(answer && *answer);
  EXPECT_THAT((*answer)->body, HasSubstr("<status>OK</status>"));
}

TEST_F(Asking, ServerErrorsHaveNoEnvelope) {
  bench.reader.faults().http_500 = 1.0;
  const auto answer = ask("/devices");
  ASSERT_TRUE(answer && *answer);
  EXPECT_EQ((*answer)->status, 500);
  EXPECT_THAT((*answer)->body, Not(HasSubstr("<response>")));
}

TEST_F(Asking, RefusedWithoutListenerSilentWithoutPower) {
  bench.reader.faults().refuse_connects = true;
  EXPECT_EQ(failure("/devices"), hal::ErrorCode::refused);
  bench.reader.faults().refuse_connects = false;
  bench.reader.power_cut(bench.now);
  EXPECT_EQ(failure("/devices"), hal::ErrorCode::timeout);
  bench.reader.power_on(bench.now);
  EXPECT_EQ(failure("/devices"), hal::ErrorCode::refused);
}

TEST_F(Asking, ARebootUnderARequestDisconnects) {
  bench.reader.faults().rest_delay = 1s;
  hal::HttpRequest request;
  request.path = "/devices";
  request.timeout = 5s;
  ASSERT_TRUE(client.start(request, bench.now).has_value());
  bench.run_until(0.5);
  bench.reader.reboot(bench.now);
  const auto answer = client.poll(bench.now);
  ASSERT_FALSE(answer.has_value());
  EXPECT_EQ(answer.error().code, hal::ErrorCode::disconnected);
}

TEST(SimHttpClientCredentials, WrongPasswordIsAuthenticationAndChangesNothing) {
  SimReaderConfig config;
  config.auth = SimReaderAuth::digest;
  config.password = "secret";
  SimReaderBench bench(config);
  hal::HttpRequest request;
  request.path = "/devices/AdvanReader-m4-160/start";
  request.timeout = 1s;
  SimHttpClient stranger{{"http", {}, "admin", "admin"}, bench.reader};
  ASSERT_TRUE(stranger.start(request, bench.now).has_value());
  const auto refused = stranger.poll(bench.now);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, hal::ErrorCode::authentication);
  EXPECT_FALSE(bench.field.on());
  SimHttpClient owner{{"http", {}, "admin", "secret"}, bench.reader};
  ASSERT_TRUE(owner.start(request, bench.now).has_value());
  EXPECT_TRUE(owner.poll(bench.now).has_value());
  EXPECT_TRUE(bench.field.on());
}

}  // namespace
}  // namespace forager::mocks
