// Any bytes given as the brakes of a board file end in brakes or in one error line, never in a crash; brakes
// that were accepted can be made: their pulses lie within their stops and their slew limit locks them in 300
// ms.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "boards/brake_board.hpp"
#include "mocks/fake_pwm.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace forager;
  const auto node =
      boards::parse_config(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz.toml");
  if (!node) return describe(node.error()).empty() ? std::abort(), 0 : 0;
  boards::ConfigIssue issue;
  boards::ConfigReader top(&*node, "", issue);
  const boards::BrakeBoard board = boards::read_brake_board(top.table("brakes"));
  check_unused(*node, issue);
  if (issue) return describe(*issue).empty() ? std::abort(), 0 : 0;
  if (!board.named) return 0;
  mocks::FakePwmGroup group("timer", 1, board.period);
  for (const boards::BrakeLine* line : {&board.left, &board.right}) {
    const bool pulses =
        line->backend != boards::BrakeBackend::gpio && line->backend != boards::BrakeBackend::modbus;
    if (pulses && !servo::PwmBrake::create(group.channel(0), line->pulses)) std::abort();
    if (line->pulses.slew_per_s < 4.0 || line->actuator.slew_per_s < 4.0) std::abort();
  }
  return 0;
}
