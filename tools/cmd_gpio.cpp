#include "tools/cmd_gpio.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "tools/bench_session.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

using boards::BenchLine;
using boards::LineFacts;

std::string_view level_word(bool active) { return active ? "active" : "inactive"; }

// What the board file calls the line; empty: nothing.
std::string board_name(const boards::BenchBoard& names, const LineFacts& line) {
  for (const BenchLine& known : names.lines)
    if ((known.chip == line.label || known.chip == line.chip) &&
        (known.line == line.name || known.line == std::to_string(line.number)))
      return known.name;
  return {};
}

int list_lines(const GpioCommand& command, BenchPlace& place, BenchOutput& output) {
  const auto lines = place.machine->lines();
  if (!lines) return complain(lines.error());
  bool any = false;
  for (const LineFacts& line : *lines) {
    if (!command.chip.empty() && command.chip != line.chip && command.chip != line.label) continue;
    any = true;
    const std::string name = board_name(place.board.bench, line);
    output.record({{"event", "line"},
                   {"chip", line.chip},
                   {"label", line.label},
                   {"number", line.number},
                   {"name", line.name},
                   {"direction", line.output ? "output" : "input"},
                   {"active_low", line.active_low},
                   {"held_by", line.held_by},
                   {"board_name", name}});
    std::string text = fmt::format("{} ({}) {:>3} {:<16} {:<6}", line.chip, line.label, line.number,
                                   line.name, line.output ? "output" : "input");
    if (line.active_low) text += " active-low";
    text += line.held_by.empty() ? " free" : fmt::format(" held by \"{}\"", line.held_by);
    if (!name.empty()) text += ", here called " + name;
    output.line(text);
  }
  if (any || command.chip.empty()) {
    if (!any) output.line("this machine has no GPIO chips");
    return kExitDone;
  }
  return complain({hal::ErrorCode::not_present, "gpio " + command.chip, "list", "there is no such chip",
                   "See what there is: forager gpio list"});
}

// The lines a person asked for, with what the command line adds to them.
hal::Result<std::vector<BenchLine>> wanted_lines(const GpioCommand& command, const BenchPlace& place) {
  std::vector<BenchLine> lines;
  for (const std::string& text : command.lines) {
    auto line = boards::find_line(place.board.bench, text);
    if (!line) return hal::fail(std::move(line).error());
    if (command.active_low) line->active_low = true;
    if (command.bias == "up") line->bias = boards::BenchBias::pull_up;
    if (command.bias == "down") line->bias = boards::BenchBias::pull_down;
    if (command.bias == "none") line->bias = boards::BenchBias::none;
    lines.push_back(*std::move(line));
  }
  return lines;
}

void tell_level(BenchOutput& output, const std::string& name, bool active) {
  output.record({{"event", "level"}, {"name", name}, {"active", active}});
  output.line(fmt::format("{}: {}", name, level_word(active)));
}

int read_lines(const std::vector<BenchLine>& lines, BenchPlace& place, BenchOutput& output) {
  for (const BenchLine& line : lines) {
    const auto in = place.machine->open_in(line);
    if (!in) return complain(in.error());
    const auto active = (*in)->active();
    if (!active) return complain(active.error());
    tell_level(output, line.name, *active);
  }
  return kExitDone;
}

int set_line(const GpioCommand& command, const BenchLine& line, BenchPlace& place, BenchOutput& output) {
  BenchLoop loop(place.machine->clock());
  const auto guard = guard_output(place, {.line = line}, "forager gpio");
  if (!guard) return complain(guard.error());
  auto out = place.machine->open_out(line);
  if (!out) return complain(out.error());
  if (const auto armed = (*guard)->arm(); !armed) return complain(armed.error());
  const bool active = command.level == "on";
  if (const auto set = (*out)->set(active); !set) return complain(set.error());
  output.record({{"event", "set"}, {"name", line.name}, {"active", active}, {"hold_s", command.hold_s}});
  output.line(fmt::format("{}: {} for {:g} s", line.name, level_word(active), command.hold_s));
  hal::Result<> guarded;
  const BenchEnd end = loop.run(hal::from_seconds(command.hold_s), [&](hal::Instant) {
    guarded = (*guard)->feed();
    return guarded.has_value();
  });
  const auto safe = line.keep_at_end ? hal::Result<>{} : (*out)->set(false);
  out->reset();
  if (!safe) {
    (*guard)->hand_over();
    return complain(safe.error());
  }
  tell_level(output, line.name, line.keep_at_end && active);
  if (!guarded) return complain(guarded.error());
  return end == BenchEnd::signalled ? complain_signalled(line.name) : kExitDone;
}

struct Watched {
  std::string name;
  std::unique_ptr<hal::EdgeIn> in;
  bool active = false;
  std::uint64_t edges = 0;
  std::uint64_t lost = 0;
};

hal::Result<> take_edges(Watched& line, hal::Instant start, BenchOutput& output) {
  std::array<hal::Edge, 16> edges;
  const auto count = line.in->edges(edges);
  if (!count) return hal::fail(count.error());
  for (std::size_t i = 0; i < *count; ++i) {
    const double at_s = hal::to_seconds(edges[i].at - start);
    ++line.edges;
    if (edges[i].active == line.active) ++line.lost;  // the one between did not fit the kernel's queue
    line.active = edges[i].active;
    output.record({{"event", "edge"}, {"t_s", at_s}, {"name", line.name}, {"active", line.active}});
    output.line(fmt::format("{:12.6f} s  {}: {}", at_s, line.name, level_word(line.active)));
  }
  return {};
}

int watch_lines(const GpioCommand& command, const std::vector<BenchLine>& lines, BenchPlace& place,
                BenchOutput& output) {
  BenchLoop loop(place.machine->clock());
  std::vector<Watched> watched;
  for (const BenchLine& line : lines) {
    auto in = place.machine->open_edges(line);
    if (!in) return complain(in.error());
    const auto active = (*in)->active();
    if (!active) return complain(active.error());
    tell_level(output, line.name, *active);
    watched.push_back({line.name, *std::move(in), *active});
  }
  const hal::Instant start = loop.now();
  hal::Result<> failed;
  const auto time = command.for_s > 0.0 ? std::optional(hal::from_seconds(command.for_s)) : std::nullopt;
  loop.run(time, [&](hal::Instant now) {
    std::vector<std::string> block;
    for (Watched& line : watched) {
      if (failed) failed = take_edges(line, start, output);
      block.push_back(fmt::format("{:9.1f} s  {}: {}, {} edges", hal::to_seconds(now - start), line.name,
                                  level_word(line.active), line.edges));
    }
    output.live(block);
    return failed.has_value();
  });
  if (!failed) return complain(failed.error());
  for (const Watched& line : watched) {
    output.record({{"event", "watched"},
                   {"name", line.name},
                   {"active", line.active},
                   {"edges", line.edges},
                   {"lost", line.lost}});
    output.line(fmt::format("{}: {} edges, {} at the end{}", line.name, line.edges, level_word(line.active),
                            line.lost > 0 ? fmt::format(", at least {} lost", line.lost) : ""));
  }
  return kExitDone;
}

void add_line_options(CLI::App* sub, GpioCommand& command, bool input) {
  sub->add_flag("--active-low", command.active_low, "Active is the low level");
  if (input)
    sub->add_option("--pull", command.bias, "Pull resistor")->check(CLI::IsMember({"up", "down", "none"}));
}

CLI::App* add_task(CLI::App& gpio, const char* name, const char* what, GpioTask task,
                   const std::shared_ptr<GpioCommand>& command, int& exit_code) {
  command->task = task;
  CLI::App* sub = gpio.add_subcommand(name, what);
  add_target_options(sub, command->target, task == GpioTask::set || task == GpioTask::watch);
  sub->callback([command, &exit_code] { exit_code = run_gpio_command(*command); });
  return sub;
}

constexpr const char* kLine = "Name of the board file, or CHIP/LINE (pinctrl-bcm2711/GPIO17, gpiochip0/17)";

}  // namespace

int run_gpio_command(const GpioCommand& command) {
  if (command.task == GpioTask::set && !command.arm)
    return complain_not_armed(fmt::format("{} would be {} for {:g} s", command.lines.front(),
                                          level_word(command.level == "on"), command.hold_s));
  auto place = open_place(command.target);
  if (!place) return complain(place.error());
  if (command.task == GpioTask::watch && place->machine->emulated() && !command.target.real_time &&
      !(command.for_s > 0.0))
    return complain_usage("emulated lines are watched with --for, or with --real-time");
  BenchOutput output(command.target.json);
  if (command.task == GpioTask::list) return list_lines(command, *place, output);
  const auto lines = wanted_lines(command, *place);
  if (!lines) return complain(lines.error());
  if (command.task == GpioTask::read) return read_lines(*lines, *place, output);
  if (command.task == GpioTask::watch) return watch_lines(command, *lines, *place, output);
  return set_line(command, lines->front(), *place, output);
}

void add_gpio_command(CLI::App& app, int& exit_code) {
  CLI::App* gpio = app.add_subcommand("gpio", "List, read, set and watch GPIO lines");
  gpio->require_subcommand(1);
  auto list = std::make_shared<GpioCommand>();
  add_task(*gpio, "list", "Every line of every chip, and who holds it", GpioTask::list, list, exit_code)
      ->add_option("--chip", list->chip, "Only this one: label or name");
  auto read = std::make_shared<GpioCommand>();
  CLI::App* sub =
      add_task(*gpio, "read", "Levels of lines; they become inputs", GpioTask::read, read, exit_code);
  sub->add_option("LINE", read->lines, kLine)->required();
  add_line_options(sub, *read, true);
  auto set = std::make_shared<GpioCommand>();
  sub = add_task(*gpio, "set", "Drive a line for a while; then it is inactive again", GpioTask::set, set,
                 exit_code);
  set->lines.emplace_back();
  sub->add_option("LINE", set->lines.front(), kLine)->required();
  sub->add_option("LEVEL", set->level, "on: active; off: inactive")
      ->required()
      ->check(CLI::IsMember({"on", "off"}));
  sub->add_option("--hold", set->hold_s, "Time, such as 2s or 500ms")
      ->required()
      ->transform(TimeSpan(0.001, 3600.0));
  sub->add_flag("--arm", set->arm, "Yes, the line may be driven");
  add_line_options(sub, *set, false);
  auto watch = std::make_shared<GpioCommand>();
  sub = add_task(*gpio, "watch", "Edges of lines as they come, until Ctrl-C", GpioTask::watch, watch,
                 exit_code);
  sub->add_option("LINE", watch->lines, kLine)->required();
  sub->add_option("--for", watch->for_s, "Stop after this time")->transform(TimeSpan(0.001, 1e6));
  add_line_options(sub, *watch, true);
}

}  // namespace forager::tools
