#include "tools/bench_session.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

void print(std::string_view text) {
  fmt::print("{}\n", text);
  std::fflush(stdout);
}

}  // namespace

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

BenchOutput::BenchOutput(bool json) : json_(json), terminal_(isatty(STDOUT_FILENO) == 1) {}

BenchOutput::~BenchOutput() { clear_live(); }

void BenchOutput::clear_live() {
  if (live_open_) fmt::print("\r\033[K");
  live_open_ = false;
  std::fflush(stdout);
}

void BenchOutput::line(std::string_view text) {
  if (json_) return;
  clear_live();
  print(one_line(text));
}

void BenchOutput::record(const nlohmann::ordered_json& object) {
  if (json_) print(object.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void BenchOutput::live(std::string_view text) {
  if (!is_live()) return;
  fmt::print("\r\033[K{}", one_line(text));
  std::fflush(stdout);
  live_open_ = true;
}

std::optional<hal::Duration> parse_time(std::string_view text, hal::Duration least, hal::Duration most) {
  double scale = 1.0;
  if (text.ends_with("ms")) {
    scale = 1e-3;
    text.remove_suffix(2);
  } else if (text.ends_with("s")) {
    text.remove_suffix(1);
  }
  double value = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  const hal::Duration time = hal::from_seconds(value * scale);
  if (time < least || time > most) return std::nullopt;
  return time;
}

std::string time_text(hal::Duration time) {
  const double seconds = hal::to_seconds(time);
  return seconds >= 1.0 || seconds == 0.0 ? fmt::format("{:g} s", seconds)
                                          : fmt::format("{:g} ms", seconds * 1e3);
}

CLI::Option* add_time_option(CLI::App* app, const std::string& name, std::optional<hal::Duration>& into,
                             const std::string& help, hal::Duration least, hal::Duration most) {
  const auto allowed = [least, most](const std::string& text) {
    return parse_time(text, least, most)
               ? std::string()
               : fmt::format("'{}' is not a time from {} to {}, such as 2s or 500ms", text, time_text(least),
                             time_text(most));
  };
  return app
      ->add_option_function<std::string>(
          name, [&into, least, most](const std::string& text) { into = parse_time(text, least, most); }, help)
      ->type_name("TIME")
      ->check(CLI::Validator(allowed, ""));
}

}  // namespace forager::tools
