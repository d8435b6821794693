#include "tools/serial_session.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "boards/run_clock.hpp"
#include "boards/serial_bench.hpp"
#include "tools/bench_session.hpp"
#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string line_text(const hal::SerialPort& port) {
  return fmt::format("{} at {}", port.name(), to_string(port.line()));
}

// What came, as one line of hex with its text beside it, sixteen bytes at most.
std::string hex_line(std::span<const std::byte> bytes) {
  std::string hex;
  std::string text;
  for (const std::byte byte : bytes) {
    hex += fmt::format("{:02x} ", std::to_integer<unsigned>(byte));
    text += printable(byte) && std::to_integer<unsigned>(byte) >= 0x20 ? static_cast<char>(byte) : '.';
  }
  return fmt::format("{:<48} {}", hex, text);
}

// Everything that comes from the line: on stdout as it is, as hex or as JSON; sent back, for an echo; and
// what is typed goes out, for a terminal.
class SerialWatch {
 public:
  SerialWatch(const SerialCommand& command, hal::SerialPort& port)
      : command_(command), port_(port), out_(command.json) {}

  int run(BenchLoop& loop) {
    if (command_.task == SerialTask::terminal)
      fcntl(STDIN_FILENO, F_SETFL, fcntl(STDIN_FILENO, F_GETFL) | O_NONBLOCK);
    std::optional<hal::Duration> time;
    if (command_.for_s > 0.0) time = hal::from_seconds(command_.for_s);
    loop.run(time, [this](hal::Instant now) { return step(now); });
    if (failure_) return complain(*failure_);
    out_.record({{"event", "end"}, {"received", received_}, {"sent", sent_}});
    fmt::print(stderr, "forager: {}: {} bytes received, {} sent\n", port_.name(), received_, sent_);
    return kExitDone;
  }

 private:
  bool step(hal::Instant now) {
    for (;;) {
      const auto count = port_.read(room_);
      if (!count) return fail(count.error());
      if (*count == 0) break;
      received_ += *count;
      const auto bytes = std::span(room_).first(*count);
      show(now, bytes);
      if (command_.task == SerialTask::echo) waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
    }
    return take_typed() && flush();
  }
  bool fail(const hal::Error& error) {
    failure_ = error;
    return false;
  }
  void show(hal::Instant now, std::span<const std::byte> bytes) {
    if (command_.json) {
      std::string hex;
      for (const std::byte byte : bytes) hex += fmt::format("{:02x}", std::to_integer<unsigned>(byte));
      return out_.record({{"event", "bytes"}, {"t_s", hal::to_seconds(now)}, {"hex", hex}});
    }
    if (!command_.hex) {
      static_cast<void>(write_output("-", text_of(bytes)));
      return;
    }
    for (; !bytes.empty(); bytes = bytes.subspan(std::min<std::size_t>(16, bytes.size())))
      out_.line(fmt::format("{:9.3f} s  {}", hal::to_seconds(now),
                            hex_line(bytes.first(std::min<std::size_t>(16, bytes.size())))));
  }
  // False at the end of what is typed, once all of it has left.
  bool take_typed() {
    if (command_.task != SerialTask::terminal || !waiting_.empty()) return true;
    const ssize_t got = ::read(STDIN_FILENO, room_.data(), room_.size());
    if (got > 0) waiting_.assign(room_.begin(), room_.begin() + got);
    if (got == 0 && command_.for_s <= 0.0) return false;
    return true;
  }
  bool flush() {
    if (waiting_.empty()) return true;
    const auto taken = port_.write(waiting_);
    if (!taken) return fail(taken.error());
    sent_ += *taken;
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(*taken));
    return true;
  }

  const SerialCommand& command_;
  hal::SerialPort& port_;
  BenchOutput out_;
  std::array<std::byte, 4096> room_{};
  std::vector<std::byte> waiting_;
  std::uint64_t received_ = 0;
  std::uint64_t sent_ = 0;
  std::optional<hal::Error> failure_;
};

}  // namespace

std::optional<hal::Error> open_port(hal::SerialPort& port, BenchLoop& loop) {
  if (auto opened = port.open(); !opened) return opened.error();
  std::optional<hal::Error> failure;
  const auto end = loop.run(5s, [&](hal::Instant) {
    const auto state = port.poll();
    if (!state) failure = state.error();
    return state && *state != hal::StreamState::open;
  });
  if (!failure && end == BenchEnd::time_over)
    failure = hal::Error{hal::ErrorCode::timeout, std::string(port.name()), "open", "it did not open", {}};
  return failure;
}

bool printable(std::byte byte) {
  const auto c = std::to_integer<unsigned>(byte);
  return (c >= 0x20 && c < 0x7F) || c == '\n' || c == '\r' || c == '\t';
}

hal::Result<hal::SerialSettings> settings_of(const SerialCommand& command, const hal::SerialSettings& line) {
  const auto wrong = [&] {
    return hal::fail(hal::ErrorCode::invalid_argument, "serial", "--format " + *command.format,
                     "is not data bits, parity and stop bits", "Such as 8N1, 8E1 or 7O2");
  };
  hal::SerialSettings settings = line;
  if (command.baud) settings.baud = *command.baud;
  if (command.format) {
    const std::string& text = *command.format;
    constexpr std::string_view kParities = "NEO";
    if (text.size() != 3 || text[0] < '5' || text[0] > '8' ||
        kParities.find(text[1]) == std::string_view::npos || text[2] < '1' || text[2] > '2')
      return wrong();
    settings.data_bits = static_cast<std::uint8_t>(text[0] - '0');
    settings.parity = static_cast<hal::Parity>(kParities.find(text[1]));
    settings.stop_bits = static_cast<std::uint8_t>(text[2] - '0');
  }
  settings.flow = command.hardware_flow ? hal::FlowControl::hardware : hal::FlowControl::none;
  FORAGER_TRY(check(settings, command.device));
  return settings;
}

int run_serial_watch(const SerialCommand& command, const hal::SerialSettings& settings) {
  const auto clock = boards::make_real_clock(1.0);
  BenchLoop loop(*clock, kSerialTick);
  const auto port = boards::serial_line(command.device, settings, *clock);
  if (const auto failure = open_port(*port, loop)) return complain(*failure);
  fmt::print(stderr, "forager: {}\n", line_text(*port));
  return SerialWatch(command, *port).run(loop);
}

}  // namespace forager::tools
