#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include "tools/accuracy_table.hpp"
#include "tools/bench_duel.hpp"
#include "tools/cli_style.hpp"
#include "tools/cmd_bench.hpp"

namespace forager::tools {
namespace {

// Work that takes longer than this by itself is measured less often.
constexpr double kLong_s = 0.05;
constexpr int kLongRepeats = 3;

void progress(std::size_t done, std::size_t all) {
  if (isatty(STDERR_FILENO) == 0) return;
  std::fprintf(stderr, "\rmeasured %zu of %zu%s", done, all, done == all ? "\r\033[K" : "");
  std::fflush(stderr);
}

// The fastest of some measurements: whatever else the machine does only makes it slower. Rows of one name in
// turn, so that it meets them alike.
void measure_group(std::span<boards::AccuracyRow> rows, int repeats) {
  std::vector<std::unique_ptr<TimedWork>> work;
  std::vector<std::vector<double>> times(rows.size());
  for (const auto& row : rows)
    work.push_back(row.work ? std::make_unique<TimedWork>(row.work, std::chrono::duration<double>(5e-3))
                            : nullptr);
  for (int turn = 0; turn < repeats; ++turn)
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (work[i] == nullptr) continue;
      if (turn >= kLongRepeats && times[i].front() > kLong_s) continue;
      times[i].push_back(work[i]->once_s());
    }
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (work[i] != nullptr)
      rows[i].time_ns = 1e9 * *std::min_element(times[i].begin(), times[i].end()) / rows[i].items;
}

std::vector<boards::AccuracyRow> measured_rows(const AccuracyCommand& command) {
  std::vector<boards::AccuracyRow> rows = boards::accuracy_rows({command.seed, command.effort});
  for (std::size_t first = 0; first < rows.size();) {
    std::size_t last = first + 1;
    while (last < rows.size() && rows[last].name == rows[first].name) ++last;
    measure_group(std::span(rows).subspan(first, last - first), command.repeats);
    progress(last, rows.size());
    first = last;
  }
  return rows;
}

}  // namespace

int run_bench_accuracy(const AccuracyCommand& command) {
  const int on_stdout = (command.json ? 1 : 0) + (command.csv == "-" ? 1 : 0) + (command.html == "-" ? 1 : 0);
  if (on_stdout > 1) return complain_usage("only one of --json, --csv - and --html - can have stdout");
  const std::vector<AccuracyLine> lines = with_pareto_fronts(measured_rows(command));
  const auto write = [&](const std::string& path, const std::string& text) {
    return write_output(path, text);
  };
  if (!command.csv.empty())
    if (const auto written = write(command.csv, accuracy_csv(lines)); !written)
      return complain(written.error());
  if (!command.html.empty())
    if (const auto written = write(command.html, accuracy_page(lines)); !written)
      return complain(written.error());
  if (command.csv == "-" || command.html == "-") return kExitDone;
  const auto written = write("-", command.json ? accuracy_json(lines) : accuracy_text(lines));
  return written ? kExitDone : complain(written.error());
}

}  // namespace forager::tools
