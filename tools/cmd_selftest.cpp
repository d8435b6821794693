#include "tools/cmd_selftest.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "boards/pin_loopback.hpp"
#include "tools/bench_session.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"
#include "tools/serial_session.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;

constexpr hal::Duration kTick = 1ms;
constexpr hal::Duration kLongest = 10min;

double in_us(hal::Duration time) { return static_cast<double>(time.count()) / 1e3; }

int complain_fault(const std::string& where, const std::string& fault) {
  fmt::print(stderr, "forager: {}: {}\n", one_line(where), fault);
  return kExitCheckFailed;
}

void report(const SelftestCommand& command, const std::string& where,
            const boards::PinLoopback::Result& result, BenchOutput& output) {
  auto latency = result.latency;
  std::sort(latency.begin(), latency.end());
  const auto part = [&latency](double share) {
    if (latency.empty()) return 0.0;
    return in_us(latency[static_cast<std::size_t>(share * static_cast<double>(latency.size() - 1))]);
  };
  output.record({{"event", "selftest"},
                 {"out", command.out},
                 {"in", command.in},
                 {"toggles", result.toggles},
                 {"edges", result.edges},
                 {"extra", result.extra},
                 {"latency_p50_us", part(0.5)},
                 {"latency_p99_us", part(0.99)},
                 {"latency_max_us", part(1.0)},
                 {"fault", result.fault}});
  output.line(fmt::format(
      "{}: {} toggles, {} edges, {} extra; from set to edge {:.1f} us p50, {:.1f} us p99, {:.1f} us max",
      where, result.toggles, result.edges, result.extra, part(0.5), part(0.99), part(1.0)));
}

int test_pins(const SelftestCommand& command, BenchPlace& place, BenchOutput& output) {
  const auto out_line = boards::find_line(place.board.bench, command.out);
  if (!out_line) return complain(out_line.error());
  const auto in_line = boards::find_line(place.board.bench, command.in);
  if (!in_line) return complain(in_line.error());
  BenchLoop loop(place.machine->clock(), kTick);
  const auto guard = guard_output(place, {.line = *out_line}, "forager selftest");
  if (!guard) return complain(guard.error());
  auto out = place.machine->open_out(*out_line);
  if (!out) return complain(out.error());
  const auto in = place.machine->open_edges(*in_line);
  if (!in) return complain(in.error());
  if (const auto armed = (*guard)->arm(); !armed) return complain(armed.error());
  const std::string where = fmt::format("{} to {}", command.out, command.in);
  boards::PinLoopback test(**out, **in, {.toggles = command.count});
  hal::Result<> failed;
  const BenchEnd end = loop.run(kLongest, [&](hal::Instant now) {
    if (failed = (*guard)->feed(); !failed) return false;
    const auto going = test.update(now);
    if (!going) failed = hal::fail(going.error());
    return going && *going;
  });
  const auto safe = (*out)->set(false);
  out->reset();
  if (!safe) (*guard)->hand_over();
  if (!failed) return complain(failed.error());
  if (!safe) return complain(safe.error());
  if (end == BenchEnd::signalled) return complain_signalled(where);
  report(command, where, test.result(), output);
  return test.result().fault.empty() ? kExitDone : complain_fault(where, test.result().fault);
}

int test_serial(const SelftestCommand& command) {
  SerialCommand serial;
  serial.device = command.serial;
  serial.baud = command.baud;
  serial.bytes = command.count;
  serial.json = command.target.json;
  const auto settings = settings_of(serial, {});
  return settings ? run_serial_loopback(serial, *settings) : complain(settings.error());
}

}  // namespace

int run_selftest_command(const SelftestCommand& command) {
  const bool pins = !command.out.empty() && !command.in.empty();
  if (pins == !command.serial.empty() || command.out.empty() != command.in.empty())
    return complain_usage(
        "selftest: say which lines are wired together: --out LINE --in LINE, or --serial PORT");
  if (command.count == 0) return complain_usage("selftest: --count 0 tests nothing");
  if (pins && !command.arm) return complain_not_armed(command.out + " would be toggled");
  if (!pins) return test_serial(command);
  auto place = open_place(command.target);
  if (!place) return complain(place.error());
  BenchOutput output(command.target.json);
  return test_pins(command, *place, output);
}

void add_selftest_command(CLI::App& app, int& exit_code) {
  auto command = std::make_shared<SelftestCommand>();
  CLI::App* sub = app.add_subcommand(
      "selftest",
      "Test two GPIO lines that are wired together, or a serial port whose TX is wired to its RX");
  add_target_options(sub, command->target, true);
  sub->add_option("--out", command->out, "The line that drives: name of the board file, or CHIP/LINE");
  sub->add_option("--in", command->in, "The line it is wired to");
  sub->add_option("--serial", command->serial, "Serial port with a wire from TX to RX");
  sub->add_option("--baud", command->baud, "Of the serial port")
      ->capture_default_str()
      ->check(WholeNumber(4000000));
  CLI::Option* count = sub->add_option("--count", command->count, "Toggles (100), or bytes (4096)")
                           ->check(WholeNumber(1000000));
  sub->add_flag("--arm", command->arm, "Yes, the line may be driven");
  sub->callback([command, count, &exit_code] {
    if (count->count() == 0 && !command->serial.empty()) command->count = 4096;
    exit_code = run_selftest_command(*command);
  });
}

}  // namespace forager::tools
