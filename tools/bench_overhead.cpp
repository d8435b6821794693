#include "tools/bench_overhead.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "boards/bench_board.hpp"
#include "boards/output_guard.hpp"
#include "tools/bench_session.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"
#include "tools/plug_session.hpp"
#include "tools/stop_signal.hpp"

namespace forager::tools {
namespace {

using Contests = hal::Result<std::vector<boards::OverheadContest>>;

Contests alone(hal::Result<boards::OverheadContest> contest) {
  if (!contest) return hal::fail(std::move(contest).error());
  std::vector<boards::OverheadContest> one;
  one.push_back(*std::move(contest));
  return one;
}

class Measurements {
 public:
  explicit Measurements(const OverheadCommand& command) : command_(&command) {}

  void skip(std::string name, std::string why) {
    rows_.push_back({.name = std::move(name), .unit = {}, .ours = {}, .bare = {}, .skipped = std::move(why)});
  }
  // `asked`: a person named the device, so that it fails is an error.
  // `watched`: asked after every pair; false ends it.
  void take(
      const std::string& name, const Contests& contests, bool asked,
      const std::function<bool()>& watched = [] { return true; }) {
    if (!contests) return fail(name, contests.error(), asked);
    for (const boards::OverheadContest& contest : *contests) {
      if (StopSignal::raised()) return;
      take(contest, asked, watched);
    }
  }
  int print() const;

  void fail(const std::string& name, const hal::Error& error, bool asked) {
    skip(name, describe(error));
    if (!asked) return;
    const int code = complain(error);
    if (exit_code_ == kExitDone) exit_code_ = code;
  }

 private:
  void take(const boards::OverheadContest& contest, bool asked, const std::function<bool()>& watched) {
    auto row = measure_overhead(contest, {.seconds = command_->seconds,
                                          .stop = [&watched] { return StopSignal::raised() || !watched(); }});
    if (row) return rows_.push_back(*std::move(row));
    const bool silent = contest.may_be_silent && row.error().code == hal::ErrorCode::timeout;
    fail(contest.name, row.error(), asked && !silent);
  }

  const OverheadCommand* command_;
  std::vector<OverheadRow> rows_;
  int exit_code_ = kExitDone;
};

// The line is made inactive by another process when this one is killed. A loop that is late harms nothing
// here.
void measure_gpio(const std::string& line, Measurements& measured) {
  constexpr const char* kName = "GPIO set";
  boards::Board board;
  board.guard_timeout = std::chrono::seconds(10);
  const auto place = boards::find_line({}, line);
  if (!place) return measured.fail(kName, place.error(), true);
  const auto guard = boards::OutputGuard::start(board, {.line = *place}, "forager bench overhead");
  if (!guard) return measured.fail(kName, guard.error(), true);
  if (const auto armed = (*guard)->arm(); !armed) return measured.fail(kName, armed.error(), true);
  measured.take(kName, alone(boards::overhead_gpio(line)), true,
                [&guard] { return (*guard)->feed().has_value(); });
}

int Measurements::print() const {
  std::string text;
  if (command_->json)
    for (const OverheadRow& row : rows_) text += overhead_json(row) + "\n";
  else
    text = overhead_table(rows_);
  if (const auto written = write_output("-", text); !written) return complain(written.error());
  return StopSignal::raised() ? complain_signalled("bench overhead") : exit_code_;
}

}  // namespace

hal::Result<OverheadRow> measure_overhead(const boards::OverheadContest& contest,
                                          const PairedOptions& options) {
  const auto pairs = time_pairs(contest, options);
  if (!pairs) return hal::fail(pairs.error());
  OverheadRow row{.name = contest.name, .unit = contest.unit, .ours = contest.ours, .bare = contest.bare};
  if (pairs->empty())
    row.skipped = "ended before its time";
  else
    row.figures = figures_of(*pairs);
  return row;
}

std::string overhead_json(const OverheadRow& row) {
  using Json = nlohmann::ordered_json;
  Json j{{"name", row.name}};
  if (row.figures) {
    const PairedFigures& f = *row.figures;
    j.update(Json{{"unit", row.unit},
                  {"ours", row.ours},
                  {"bare", row.bare},
                  {"time_ns", f.ours_ns},
                  {"bare_ns", f.bare_ns},
                  {"added_ns", f.added_ns},
                  {"cpu_ns", f.ours_cpu_ns},
                  {"bare_cpu_ns", f.bare_cpu_ns},
                  {"ratio", f.ratio.median},
                  {"ratio_low", f.ratio_low},
                  {"ratio_high", f.ratio_high},
                  {"ratio_p5", f.ratio.p5},
                  {"ratio_p95", f.ratio.p95},
                  {"pairs", f.pairs}});
  } else {
    j["skipped"] = row.skipped;
  }
  return j.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string overhead_table(std::span<const OverheadRow> rows) {
  std::string out = fmt::format("{:<28} {:>12} {:>12} {:>10}  {:<24} {}\n", "", "ours, ns", "bare, ns",
                                "added, ns", "ratio (95 % confidence)", "per");
  for (const OverheadRow& row : rows) {
    if (!row.figures) {
      out += fmt::format("{:<28} skipped: {}\n", row.name, one_line(row.skipped));
      continue;
    }
    const PairedFigures& f = *row.figures;
    const std::string ratio =
        fmt::format("{:.3f} ({:.3f} to {:.3f})", f.ratio.median, f.ratio_low, f.ratio_high);
    out += fmt::format("{:<28} {:>12.4g} {:>12.4g} {:>10.3g}  {:<24} {} of {}, {} pairs\n", row.name,
                       f.ours_ns, f.bare_ns, f.added_ns, ratio, row.unit, row.bare, f.pairs);
  }
  return out;
}

int run_bench_overhead(const OverheadCommand& command) {
  if (!command.arm && !command.gpio.empty())
    return complain_not_armed(fmt::format("{} would be toggled for {:g} s", command.gpio, command.seconds));
  if (!command.arm && !command.usb.empty())
    return complain_not_armed(fmt::format("{} would be sent bytes for seconds", command.usb));
  const auto id = usb_id_from(command.usb);
  if (!command.usb.empty() && !id)
    return complain_usage(fmt::format("'{}' is no VID:PID, such as 0403:6001", command.usb));
  const StopSignal signals;
  Measurements measured(command);
  if (command.gpio.empty())
    measured.skip("GPIO set", "needs a free line: --gpio CHIP/LINE --arm");
  else
    measure_gpio(command.gpio, measured);
  if (command.i2c.empty())
    measured.skip("I2C transfer", "needs a chip that may be read: --i2c BUS@ADDRESS");
  else
    measured.take("I2C transfer", alone(boards::overhead_i2c(command.i2c)), true);
  measured.take("I2C transfer over nothing", alone(boards::overhead_i2c_floor()), false);
  measured.take("Modbus round trip", alone(boards::overhead_modbus()), false);
  if (id)
    measured.take("USB", boards::overhead_usb({id->vendor, id->product, command.baud}), true);
  else
    measured.skip("USB", "needs a CDC-ACM or FTDI adapter: --usb VID:PID --arm");
  return measured.print();
}

void add_overhead_command(CLI::App& bench, int& exit_code) {
  auto command = std::make_shared<OverheadCommand>();
  CLI::App* overhead = bench.add_subcommand(
      "overhead", "What the hardware layer costs over the vendors' own calls, made in turn");
  overhead->add_option("--gpio", command->gpio, "Line to toggle: CHIP/LINE");
  overhead->add_option("--i2c", command->i2c, "Chip to read register 0 of: BUS@ADDRESS");
  overhead->add_option("--usb", command->usb, "CDC-ACM or FTDI adapter to send bytes to: VID:PID");
  overhead->add_option("--baud", command->baud, "Of that adapter's line")
      ->capture_default_str()
      ->check(WholeNumber(57600, 12000000));
  overhead->add_option("--seconds", command->seconds, "Of each measurement")
      ->capture_default_str()
      ->check(NumberBetween(0.01, 3600.0));
  overhead->add_flag("--arm", command->arm, "Yes, the line may be toggled and bytes sent");
  overhead->add_flag("--json", command->json,
                     "JSON lines: name, time_ns, bare_ns, added_ns, ratio with its spread, or skipped: why");
  overhead->callback([command, &exit_code] { exit_code = run_bench_overhead(*command); });
}

}  // namespace forager::tools
