#include "tools/esc_output.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

using Json = nlohmann::ordered_json;

double us(hal::Duration d) { return std::chrono::duration<double, std::micro>(d).count(); }

void print(const Json& line) {
  fmt::print("{}\n", line.dump());
  std::fflush(stdout);
}

Json seen_of(const boards::EscSeen& seen) {
  return {{"state", seen.state},
          {"spin", seen.spin},
          {"stop_us", seen.stop_us},
          {"full_us", seen.full_us},
          {"calibrated", seen.calibrated}};
}

}  // namespace

void EscOutput::note(hal::Instant now, std::string_view source, std::string_view text) {
  if (ended_ || (!pulses_ && source == "esc" && text.ends_with(" us"))) return;
  if (json_)
    return print({{"event", "note"}, {"t_s", hal::to_seconds(now)}, {"source", source}, {"text", text}});
  fmt::print("{:9.3f} s  {}: {}\n", hal::to_seconds(now), source, one_line(text));
  std::fflush(stdout);
}

void EscOutput::tell(hal::Instant now, std::string_view text) {
  if (json_) print({{"event", "tell"}, {"t_s", hal::to_seconds(now)}, {"text", text}});
  fmt::print(stderr, "forager: {}\n", text);
}

void EscOutput::list(const boards::EscBoard& board) {
  const bool emulated = board.output == boards::EscOutput::emulated;
  const flight::EscPulses& pulses = board.bank.pulses;
  if (json_) {
    Json motors = Json::array();
    for (const boards::EscMotor& motor : board.motors)
      motors.push_back({{"name", motor.name}, {"channel", motor.channel}});
    return print({{"event", "list"},
                  {"output", output_text(board)},
                  {"protocol", to_string(pulses.protocol)},
                  {"frequency_hz", 1.0 / hal::to_seconds(board.period)},
                  {"stop_us", us(pulses.stop)},
                  {"idle_us", us(pulses.idle)},
                  {"full_us", us(pulses.full)},
                  {"high_us", us(pulses.high)},
                  {"motors", motors}});
  }
  fmt::print("output    {}\n", emulated ? "emulated in this process" : one_line(output_text(board)));
  fmt::print("protocol  {} at {:.1f} Hz\n", to_string(pulses.protocol), 1.0 / hal::to_seconds(board.period));
  fmt::print("pulses    stop {:.1f}, idle {:.1f}, full {:.1f}, calibration {:.1f} us\n", us(pulses.stop),
             us(pulses.idle), us(pulses.full), us(pulses.high));
  for (const boards::EscMotor& motor : board.motors)
    fmt::print("motor     {} on channel {}\n", one_line(motor.name), motor.channel);
}

void EscOutput::end(const flight::EscBank& bank, const boards::EscBench& bench, hal::Instant now) {
  ended_ = true;
  Json motors = Json::array();
  for (std::size_t i = 0; i < bank.size(); ++i) {
    const double pulse = us(bank.pulse(i).value_or(hal::Duration::zero()));
    const auto seen = bench.seen(i);
    if (json_) {
      Json motor = {{"name", bank.name(i)}, {"pulse_us", pulse}};
      if (seen) motor["emulated"] = seen_of(*seen);
      motors.push_back(std::move(motor));
      continue;
    }
    fmt::print("{:12} {:7.1f} us", one_line(bank.name(i)), pulse);
    if (seen)
      fmt::print("   emulated: {}, speed {:.2f}, takes {:.1f} us for stop and {:.1f} us for full",
                 seen->state, seen->spin, seen->stop_us, seen->full_us);
    fmt::print("\n");
  }
  if (json_)
    print({{"event", "end"},
           {"t_s", hal::to_seconds(now)},
           {"state", to_string(bank.state())},
           {"reason", bank.reason()},
           {"motors", motors}});
}

}  // namespace forager::tools
