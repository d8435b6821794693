#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "boards/run_clock.hpp"
#include "boards/serial_bench.hpp"
#include "hal/random.hpp"
#include "tools/bench_session.hpp"
#include "tools/cli_style.hpp"
#include "tools/serial_session.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

// Sends a pattern and compares what comes back, for a line whose TX is wired to its RX.
class Loopback {
 public:
  Loopback(const SerialCommand& command, hal::SerialPort& port) : port_(port), pattern_(command.bytes) {
    hal::Random random(command.seed);
    for (std::byte& byte : pattern_) byte = static_cast<std::byte>(random.next());
  }
  // Until all is back, or nothing has come for a second.
  std::optional<hal::Error> run(BenchLoop& loop) {
    started_ = last_ = loop.now();
    loop.run(std::nullopt, [this](hal::Instant now) {
      if (auto error = step(now)) failure_ = std::move(error);
      return !failure_ && back_ < pattern_.size() && now - last_ < 1s;
    });
    return failure_;
  }
  [[nodiscard]] int report(bool json) const {
    const double seconds = hal::to_seconds(last_ - started_);
    const double rate = seconds > 0.0 ? static_cast<double>(back_) / seconds : 0.0;
    const bool good = back_ == pattern_.size() && wrong_ == 0;
    BenchOutput out(json);
    out.record({{"event", "loopback"},
                {"sent", sent_},
                {"back", back_},
                {"wrong", wrong_},
                {"first_wrong", first_wrong_ ? Json(*first_wrong_) : Json(nullptr)},
                {"bytes_s", rate}});
    out.line(fmt::format(
        "{}: {} bytes sent, {} came back, {} of them wrong{}, {:.0f} bytes/s", port_.name(), sent_, back_,
        wrong_, first_wrong_ ? fmt::format(" (the first at {})", *first_wrong_) : std::string(), rate));
    if (good) return kExitDone;
    fmt::print(stderr, "forager: {}: {}\n", port_.name(),
               back_ == 0    ? "nothing came back: TX and RX are not connected, or not to each other"
               : wrong_ == 0 ? "bytes are missing: noise, or an adapter that cannot keep up"
                             : "bytes came back wrong: noise, a missing ground, or somebody else sends, too");
    return kExitCheckFailed;
  }

 private:
  std::optional<hal::Error> step(hal::Instant now) {
    // No further ahead than a small adapter's buffer holds.
    const std::size_t ahead = std::min(pattern_.size(), back_ + 256);
    if (sent_ < ahead) {
      const auto taken = port_.write(std::span(pattern_).subspan(sent_, ahead - sent_));
      if (!taken) return taken.error();
      sent_ += *taken;
    }
    std::array<std::byte, 512> room;
    const auto count = port_.read(room);
    if (!count) return count.error();
    for (std::size_t i = 0; i < *count && back_ < pattern_.size(); ++i, ++back_) {
      if (room[i] == pattern_[back_]) continue;
      ++wrong_;
      if (!first_wrong_) first_wrong_ = back_;
    }
    if (*count > 0) last_ = now;
    return std::nullopt;
  }

  hal::SerialPort& port_;
  std::vector<std::byte> pattern_;
  std::size_t sent_ = 0;
  std::size_t back_ = 0;
  std::uint64_t wrong_ = 0;
  std::optional<std::size_t> first_wrong_;
  hal::Instant started_;
  hal::Instant last_;
  std::optional<hal::Error> failure_;
};

}  // namespace

int run_serial_loopback(const SerialCommand& command, const hal::SerialSettings& settings) {
  const auto clock = boards::make_real_clock(1.0);
  BenchLoop loop(*clock, kSerialTick);
  const auto port = boards::serial_line(command.device, settings, *clock);
  if (const auto failure = open_port(*port, loop)) return complain(*failure);
  Loopback test(command, *port);
  if (const auto failure = test.run(loop)) return complain(*failure);
  return test.report(command.json);
}

}  // namespace forager::tools
