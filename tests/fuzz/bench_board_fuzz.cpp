// Tables of single devices in a board file, and the places a person writes on a command line: refused or
// taken within their limits, whatever the bytes.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "boards/bench_board.hpp"
#include "servo/pulse_map.hpp"

namespace {

using namespace forager;

void demand(bool condition) {
  if (!condition) std::abort();
}

void read_file(std::string_view text) {
  const auto node = boards::parse_config(text, "fuzz.toml");
  if (!node) return;
  boards::ConfigIssue issue;
  boards::ConfigReader top(&*node, "", issue);
  const boards::BenchBoard board = boards::read_bench_board(top);
  if (issue) return;
  for (const boards::BenchServo& servo : board.servos) {
    demand(servo::PulseMap::between({0.0, servo.from}, {1.0, servo.to}).has_value());
    demand(boards::find_servo(board, servo.name).has_value());
    demand(servo.place.period > hal::Duration::zero());
  }
  for (const boards::BenchLine& line : board.lines) demand(boards::find_line(board, line.name).has_value());
  for (const boards::BenchChip& chip : board.chips) demand(chip.address >= 8 && chip.address <= 0x77);
}

void read_places(const std::string& text) {
  const boards::BenchBoard board;
  if (const auto pwm = boards::find_pwm(board, text); pwm && pwm->backend == boards::PwmBackend::pca9685)
    demand(pwm->channel < 16 && pwm->address >= 8 && pwm->address <= 0x77);
  if (const auto chip = boards::find_chip(board, text)) demand(chip->address >= 8 && chip->address <= 0x77);
  if (const auto line = boards::find_line(board, text)) demand(!line->chip.empty() && !line->line.empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  read_file(text);
  read_places(std::string(text));
  return 0;
}
