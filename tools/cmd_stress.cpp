#include "tools/cmd_stress.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "boards/stress_case.hpp"
#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

std::string json_of(const std::vector<boards::StressCase>& cases) {
  using Json = nlohmann::ordered_json;
  std::string out;
  for (const boards::StressCase& c : cases) {
    // JSON has no number for what is not one; null says as much.
    const Json j{{"case", c.name},
                 {"worst", std::isfinite(c.worst) ? Json(c.worst) : Json()},
                 {"bound", c.bound},
                 {"ok", c.ok()}};
    out += j.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  }
  return out;
}

std::string table_of(const std::vector<boards::StressCase>& cases) {
  std::size_t width = 4;
  for (const boards::StressCase& c : cases) width = std::max(width, c.name.size());
  std::string out = fmt::format("{:{}}  {:>11}  {:>10}\n", "case", width, "worst error", "bound");
  for (const boards::StressCase& c : cases)
    out += fmt::format("{:{}}  {:>11.3g}  {:>10.3g}  {}\n", c.name, width, c.worst, c.bound,
                       c.ok() ? "ok" : "BEYOND ITS BOUND");
  const auto held = std::count_if(cases.begin(), cases.end(), [](const auto& c) { return c.ok(); });
  return out + fmt::format("\n{} of {} cases within their bounds\n", held, cases.size());
}

}  // namespace

int run_stress(const StressCommand& command) {
  const std::vector<boards::StressCase> cases = boards::stress_cases();
  if (const auto written = write_output("-", command.json ? json_of(cases) : table_of(cases)); !written)
    return complain(written.error());
  const bool all = std::all_of(cases.begin(), cases.end(), [](const auto& c) { return c.ok(); });
  return all ? kExitDone : kExitCheckFailed;
}

void add_stress_command(CLI::App& app, int& exit_code) {
  auto command = std::make_shared<StressCommand>();
  CLI::App* stress = app.add_subcommand(
      "stress", "Put numerically hard cases to the code: the worst error of each beside its bound");
  stress->add_flag("--json", command->json, "JSON lines: case, worst, bound, ok");
  stress->callback([command, &exit_code] { exit_code = run_stress(*command); });
}

}  // namespace forager::tools
