#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "boards/bench_board.hpp"
#include "boards/overhead_contest.hpp"
#include "hal/linux/bare_calls.hpp"
#include "hal/linux/gpio.hpp"

namespace forager::boards {
namespace {

hal::Result<OverheadContest::Side> open_ours(const hal::GpioLineConfig& line) {
  auto opened = hal::open_gpio_out(line);
  if (!opened) return hal::fail(std::move(opened).error());
  const std::shared_ptr<hal::DigitalOut> out = *std::move(opened);
  const auto run = [out](std::uint64_t calls) -> hal::Result<std::uint64_t> {
    for (std::uint64_t i = 0; i < calls; ++i) FORAGER_TRY(out->set((i & 1U) == 0));
    return calls;
  };
  return OverheadContest::Side(run);
}

}  // namespace

hal::Result<OverheadContest> overhead_gpio(const std::string& line) {
  const auto place = find_line({}, line);
  if (!place) return hal::fail(place.error());
  const hal::GpioLineConfig config{.chip = place->chip, .line = place->line};
  // Opening it tells every way in which it cannot be opened.
  if (const auto tried = hal::open_gpio_out(config); !tried) return hal::fail(tried.error());
  const auto facts = hal::list_gpio();
  if (!facts) return hal::fail(facts.error());
  const auto found = std::find_if(facts->begin(), facts->end(), [&](const hal::GpioLineFacts& each) {
    const bool chip =
        config.chip == each.chip || config.chip == each.label || config.chip == "/dev/" + each.chip;
    return chip && (config.line == each.name || config.line == std::to_string(each.number));
  });
  if (found == facts->end())
    return hal::fail(hal::ErrorCode::not_present, "gpio " + line, "find", "the line is gone");
  return OverheadContest{.name = "GPIO set",
                         .ours = "DigitalOut::set",
                         .bare = hal::gpio_library(),
                         .unit = "call",
                         .batch = std::chrono::milliseconds(1),
                         .open_ours = [config] { return open_ours(config); },
                         .open_bare = [chip = "/dev/" + found->chip,
                                       number = found->number] { return hal::open_bare_gpio(chip, number); }};
}

}  // namespace forager::boards
