#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "boards/run_clock.hpp"
#include "boards/serial_bench.hpp"
#include "flight/mavlink/parser.hpp"
#include "tools/bench_session.hpp"
#include "tools/cli_style.hpp"
#include "tools/serial_session.hpp"

namespace forager::tools {
namespace {

constexpr std::array<std::uint32_t, 9> kUsualRates{115200, 57600,  9600,   19200, 38400,
                                                   230400, 460800, 921600, 4800};

// What was heard at one rate.
struct Heard {
  std::uint32_t baud = 0;
  std::uint64_t bytes = 0;
  std::uint64_t text = 0;  // of them printable
  std::uint64_t mavlink_frames = 0;

  [[nodiscard]] double text_share() const {
    return bytes > 0 ? static_cast<double>(text) / static_cast<double>(bytes) : 0.0;
  }
  [[nodiscard]] std::string verdict() const {
    if (bytes == 0) return "nothing";
    if (mavlink_frames > 0) return fmt::format("MAVLink, {} frames", mavlink_frames);
    return text_share() > 0.95 ? "text" : "no text and no protocol known here";
  }
};

std::optional<hal::Error> listen_at(const SerialCommand& command, hal::SerialSettings settings,
                                    BenchLoop& loop, Heard& heard) {
  settings.baud = heard.baud;
  const auto port = boards::serial_line(command.device, settings, loop.clock());
  if (auto failure = open_port(*port, loop)) return failure;
  flight::mavlink::Parser parser;
  std::optional<hal::Error> failure;
  loop.run(hal::from_seconds(command.for_s), [&](hal::Instant) {
    std::array<std::byte, 4096> room;
    const auto count = port->read(room);
    if (!count) {
      failure = count.error();
      return false;
    }
    const auto bytes = std::span(room).first(*count);
    heard.bytes += *count;
    heard.text += static_cast<std::uint64_t>(std::ranges::count_if(bytes, printable));
    parser.feed(bytes, [&](const flight::mavlink::Frame&) { ++heard.mavlink_frames; });
    return true;
  });
  return failure;
}

}  // namespace

int run_serial_baud(const SerialCommand& command, const hal::SerialSettings& settings) {
  const auto clock = boards::make_real_clock(1.0);
  BenchLoop loop(*clock, kSerialTick);
  BenchOutput out(command.json);
  std::vector<std::uint32_t> rates = command.rates;
  if (rates.empty()) rates.assign(kUsualRates.begin(), kUsualRates.end());
  bool known = false;
  std::uint64_t bytes = 0;
  for (const std::uint32_t rate : rates) {
    if (StopSignal::raised()) break;
    Heard heard{.baud = rate};
    const auto failure = listen_at(command, settings, loop, heard);
    if (failure && failure->code != hal::ErrorCode::unsupported) return complain(*failure);
    const std::string verdict = failure ? "this adapter cannot have that rate" : heard.verdict();
    known = known || heard.mavlink_frames > 0 || (heard.bytes > 0 && heard.text_share() > 0.95);
    bytes += heard.bytes;
    out.record({{"event", "baud"},
                {"baud", rate},
                {"bytes", heard.bytes},
                {"text_share", heard.text_share()},
                {"mavlink_frames", heard.mavlink_frames},
                {"verdict", verdict}});
    out.line(fmt::format("{:>8} baud  {:>6} bytes  {}", rate, heard.bytes, verdict));
  }
  if (known) return kExitDone;
  fmt::print(
      stderr, "forager: {}: {}\n", one_line(command.device),
      bytes == 0
          ? "nothing came at any rate: the far device is off, silent until asked, or TX and RX are swapped"
          : "bytes came and made sense at no rate: another rate, another format, or a binary protocol");
  return kExitCheckFailed;
}

}  // namespace forager::tools
