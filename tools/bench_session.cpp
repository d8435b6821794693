#include "tools/bench_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/cli_style.hpp"

namespace forager::tools {
BenchEnd BenchLoop::run(std::optional<hal::Duration> time,
                        const std::function<bool(hal::Instant now)>& step) {
  const hal::Instant start = clock_->now();
  const hal::Instant end = time ? start + *time : hal::Instant::max();
  hal::Instant next = start;
  while (true) {
    if (StopSignal::raised()) return BenchEnd::signalled;
    if (!step(clock_->now())) return BenchEnd::done;
    if (clock_->now() >= end) return BenchEnd::time_over;
    next = std::max(next + tick_, clock_->now());  // what was missed is not made up for
    clock_->sleep_until(std::min(next, end));
  }
}

void BenchOutput::line(const std::string& text) {
  if (!json_) view_.say(text);
}

void BenchOutput::record(const nlohmann::ordered_json& object) {
  if (!json_) return;
  fmt::print("{}\n", object.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  std::fflush(stdout);
}

void BenchOutput::live(const std::vector<std::string>& block) {
  if (view_.live()) view_.show(block);
}

std::string time_text(hal::Duration time) {
  const double seconds = hal::to_seconds(time);
  return seconds >= 1.0 || seconds == 0.0 ? fmt::format("{:g} s", seconds)
                                          : fmt::format("{:g} ms", seconds * 1e3);
}

int complain_not_armed(const std::string& what) {
  return complain_usage("nothing is driven without --arm: " + what);
}

int complain_signalled(const std::string& name) {
  fmt::print(stderr, "forager: {}: ended by {} before its time\n", one_line(name), StopSignal::name());
  return kExitFailure;
}

}  // namespace forager::tools
