#include "tools/brake_output.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

double in_us(hal::Duration pulse) { return static_cast<double>(pulse.count()) / 1e3; }

void print(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);  // whoever watches reads along
}

// Where the brake is attached, in words of the board file.
std::string place_of(const boards::BrakeLine& line) {
  switch (line.backend) {
    case boards::BrakeBackend::sysfs_pwm:
      return fmt::format("{} channel {}", line.chip, line.channel);
    case boards::BrakeBackend::pca9685:
      return fmt::format("{} 0x{:02x} channel {}", line.bus, line.address, line.channel);
    case boards::BrakeBackend::software_pwm:
    case boards::BrakeBackend::gpio:
      return fmt::format("{} {}", line.chip, line.line);
    case boards::BrakeBackend::modbus:
      return fmt::format("{} unit {} register {}", line.bus, line.actuator.unit,
                         line.actuator.target.address);
    case boards::BrakeBackend::autopilot:
      return fmt::format("output {}", line.channel);
    case boards::BrakeBackend::sim:
      break;
  }
  return "in this process";
}

std::string travel_of(const boards::BrakeLine& line) {
  if (line.backend == boards::BrakeBackend::gpio)
    return line.when_active == servo::WhenActive::opens ? "active opens" : "active locks";
  if (line.backend == boards::BrakeBackend::modbus)
    return fmt::format("open {:g}, locked {:g}", line.actuator.open_value, line.actuator.locked_value);
  return fmt::format("open {:g} us, locked {:g} us", in_us(line.pulses.open_pulse),
                     in_us(line.pulses.locked_pulse));
}

}  // namespace

void BrakeOutput::line(std::string_view side, const boards::BrakeLine& line) const {
  const std::string_view backend = to_string(line.backend);
  if (json_)
    return print(nlohmann::ordered_json{{"event", "brake"},
                                        {"side", side},
                                        {"backend", backend},
                                        {"place", place_of(line)},
                                        {"travel", travel_of(line)}}
                     .dump());
  print(one_line(fmt::format("{:<6} {:<10} {}; {}", side, backend, place_of(line), travel_of(line))));
}

void BrakeOutput::list(const boards::BrakeBoard& board) const {
  line("left", board.left);
  line("right", board.right);
}

void BrakeOutput::note(hal::Instant now, std::string_view source, std::string_view text) const {
  if (json_)
    return print(nlohmann::ordered_json{
        {"event", "note"}, {"t_s", hal::to_seconds(now)}, {"source", source}, {"text", text}}
                     .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  print(one_line(fmt::format("{:9.3f} s  {}: {}", hal::to_seconds(now), source, text)));
}

void BrakeOutput::state(hal::Instant now, const servo::BrakePair& pair, const boards::BrakeBench& bench) {
  const servo::BrakeStatus& status = pair.status();
  // No finer than an output shows: the last hair of a slew is no news, but where it ends is.
  const double left = std::round(status.left_fraction * 1e3) / 1e3;
  const double right = std::round(status.right_fraction * 1e3) / 1e3;
  const std::string key = fmt::format("{} {} {} {} {}", static_cast<int>(status.state), left, right,
                                      bench.left_text(), bench.right_text());
  if (key == last_) return;
  last_ = key;
  if (json_)
    return print(nlohmann::ordered_json{{"event", "state"},
                                        {"t_s", hal::to_seconds(now)},
                                        {"state", to_string(status.state)},
                                        {"cut_thrust", status.cut_thrust},
                                        {"left", left},
                                        {"right", right},
                                        {"left_output", bench.left_text()},
                                        {"right_output", bench.right_text()}}
                     .dump());
  print(one_line(fmt::format("{:9.3f} s  {:<9}  left {:4.2f} ({})  right {:4.2f} ({})", hal::to_seconds(now),
                             to_string(status.state), left, bench.left_text(), right, bench.right_text())));
}

}  // namespace forager::tools
