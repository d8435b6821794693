#include "tools/bench_jitter.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <string>

#include "boards/jitter_bench.hpp"
#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

void add(std::vector<BenchRow>& rows, const std::string& what, const boards::Lateness& late) {
  rows.push_back({what + ", median", hal::to_seconds(late.median), "s", ""});
  rows.push_back({what + ", 99 %", hal::to_seconds(late.most_of_99), "s", ""});
  rows.push_back({what + ", worst", hal::to_seconds(late.worst), "s", ""});
}

}  // namespace

hal::Result<std::vector<BenchRow>> bench_jitter(double seconds) {
  std::vector<BenchRow> rows;
  for (const double frequency_hz : {50.0, 333.0})
    for (const bool loaded : {false, true}) {
      const auto figures = boards::measure_jitter({frequency_hz, loaded, hal::from_seconds(seconds)});
      if (!figures) return hal::fail(figures.error());
      const std::string name =
          fmt::format("software PWM {:g} Hz {}", frequency_hz, loaded ? "under load" : "idle");
      add(rows, name + ": pulse off by", figures->pulse);
      add(rows, name + ": period off by", figures->period);
      rows.push_back({name + ": periods left out", static_cast<double>(figures->missed_periods), "", ""});
      if (rows.size() == 7) fmt::print(stderr, "forager: software PWM: {}\n", figures->facts);
    }
  return rows;
}

int run_bench_jitter(const JitterCommand& command) {
  const auto rows = bench_jitter(command.seconds);
  if (!rows) return complain(rows.error());
  std::string text;
  if (command.json)
    for (const BenchRow& row : *rows) text += bench_json(row) + "\n";
  else
    text = bench_table(*rows);
  if (const auto written = write_output("-", text); !written) return complain(written.error());
  return kExitDone;
}

}  // namespace forager::tools
