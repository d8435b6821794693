#include "tools/cmd_report.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>
#include <vector>

#include "boards/layout_check.hpp"
#include "reader/inventory_export.hpp"
#include "reader/inventory_store.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"
#include "tools/layout_output.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;

// A mission that closes its inventory holds the file for a moment.
constexpr hal::Duration kBusyWait = 2s;

struct Contents {
  std::vector<std::pair<std::string, std::string>> facts;
  std::vector<reader::InventoryItem> items;
  std::vector<reader::PortTotal> ports;
  reader::InventorySummary summary;
  std::uint64_t batches = 0;
};

hal::Result<Contents> load(const std::string& path) {
  reader::StoreOptions options;
  options.mode = reader::StoreMode::read;
  options.busy_wait = kBusyWait;
  const auto store = open_sqlite_inventory(path, options);
  if (!store) return hal::fail(store.error());
  auto facts = (*store)->facts();
  if (!facts) return hal::fail(std::move(facts).error());
  auto items = (*store)->items();
  if (!items) return hal::fail(std::move(items).error());
  auto ports = (*store)->port_totals();
  if (!ports) return hal::fail(std::move(ports).error());
  const auto summary = reader::summarize(*items);
  return Contents{std::move(*facts), std::move(*items), std::move(*ports), summary, (*store)->last_batch()};
}

double share_percent(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

void append_line(std::string& out, std::string_view name, std::size_t width, std::string_view value) {
  fmt::format_to(std::back_inserter(out), "  {:<{}}  {}\n", one_line(name), width, one_line(value));
}

void append_summary(std::string& out, const Contents& contents) {
  const reader::InventorySummary& summary = contents.summary;
  std::size_t width = 9;
  for (const auto& [key, value] : contents.facts) width = std::max(width, key.size());
  if (!contents.facts.empty()) out += "Run\n";
  for (const auto& [key, value] : contents.facts) append_line(out, key, width, value);
  out += "Inventory\n";
  append_line(out, "items", width, fmt::format("{}", summary.items));
  append_line(out, "reads", width,
              fmt::format("{} in {} {}", summary.reads, contents.batches,
                          contents.batches == 1 ? "batch" : "batches"));
  if (summary.items == 0) return;
  append_line(out, "heard", width,
              fmt::format("for {:.1f} s, from {:.1f} s to {:.1f} s on the run's time line",
                          hal::to_seconds(summary.last_seen - summary.first_seen),
                          hal::to_seconds(summary.first_seen), hal::to_seconds(summary.last_seen)));
  append_line(out, "best RSSI", width,
              fmt::format("{} dBm median over items, {} to {} dBm", summary.median_best_dbm,
                          summary.weakest_best_dbm, summary.strongest_dbm));
  append_line(out, "located", width,
              fmt::format("{} items ({:.1f} %) with a pose at their strongest read", summary.located,
                          share_percent(summary.located, summary.items)));
}

void append_ports(std::string& out, const Contents& contents) {
  if (contents.ports.empty()) return;
  out += "By port\n";
  out += "  port  heard best   share     reads   share\n";
  for (const reader::PortTotal& port : contents.ports)
    fmt::format_to(std::back_inserter(out), "  {:>4}  {:>10}  {:>5.1f}%  {:>8}  {:>5.1f}%\n", port.port,
                   port.items, share_percent(port.items, contents.summary.items), port.reads,
                   share_percent(port.reads, contents.summary.reads));
}

void append_items(std::string& out, const Contents& contents) {
  std::size_t width = 3;
  for (const auto& item : contents.items) width = std::max(width, 2 * item.epc.bytes().size());
  out += "Items\n";
  fmt::format_to(std::back_inserter(out), "  {:<{}}  {:>6}  {:>9}  {:>9}  {:>8}  {:>4}\n", "EPC", width,
                 "reads", "first [s]", "last [s]", "best dBm", "port");
  for (const auto& item : contents.items)
    fmt::format_to(std::back_inserter(out), "  {:<{}}  {:>6}  {:>9.2f}  {:>9.2f}  {:>8}  {:>4}\n",
                   item.epc.hex(), width, item.count, hal::to_seconds(item.first_seen),
                   hal::to_seconds(item.last_seen), item.best_rssi_dbm, item.best_port);
}

std::string table(const Contents& contents, bool with_items) {
  std::string out;
  append_summary(out, contents);
  append_ports(out, contents);
  if (with_items) append_items(out, contents);
  return out;
}

std::string json_lines(const Contents& contents, bool with_items) {
  const reader::InventorySummary& summary = contents.summary;
  nlohmann::ordered_json line{{"type", "summary"},
                              {"items", summary.items},
                              {"reads", summary.reads},
                              {"batches", contents.batches},
                              {"located", summary.located}};
  if (summary.items != 0) {
    line["first_seen_s"] = hal::to_seconds(summary.first_seen);
    line["last_seen_s"] = hal::to_seconds(summary.last_seen);
    line["best_rssi_dbm"] = {{"median", summary.median_best_dbm},
                             {"weakest", summary.weakest_best_dbm},
                             {"strongest", summary.strongest_dbm}};
  }
  line["ports"] = nlohmann::ordered_json::array();
  for (const reader::PortTotal& port : contents.ports)
    line["ports"].push_back({{"port", port.port}, {"items", port.items}, {"reads", port.reads}});
  line["facts"] = nlohmann::ordered_json::object();
  for (const auto& [key, value] : contents.facts) line["facts"][key] = value;
  // Facts may hold any bytes; what is not UTF-8 is replaced, never an exception.
  std::string out = line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  if (with_items) out += reader::to_json_lines(contents.items);
  return out;
}

}  // namespace

int run_report_command(const ReportOptions& options) {
  if (options.json && options.csv == "-")
    return complain_usage("report: --json and --csv - both want stdout. Give --csv a file");
  std::error_code ignored;
  const bool folder = std::filesystem::is_directory(options.database, ignored);
  const auto contents = load(folder ? options.database + "/inventory.sqlite" : options.database);
  if (!contents) return complain(contents.error());
  if (!options.csv.empty()) {
    if (const auto written = write_output(options.csv, reader::to_csv(contents->items)); !written)
      return complain(written.error());
    if (options.csv == "-") return kExitDone;
  }
  std::string text = options.json ? json_lines(*contents, options.items) : table(*contents, options.items);
  if (!options.layout.empty()) {
    const auto check = boards::check_layout_file(contents->items, options.layout, options.reach_m);
    if (!check) return complain(check.error());
    text += options.json ? layout_json_lines(*check) : layout_table(*check);
  }
  if (const auto written = write_output("-", text); !written) return complain(written.error());
  return kExitDone;
}

void add_report_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command = app.add_subcommand("report", "Show what a run found, from its inventory file");
  command->add_option("inventory", options->database, "Inventory file that a run wrote, or its folder")
      ->required();
  command->add_option("--csv", options->csv, "Write the items as CSV to this file, - for stdout");
  command->add_flag("--items", options->items, "List every item");
  command->add_flag("--json", options->json, "JSON lines on stdout: a summary, then the items if asked for");
  command->add_option("--layout", options->layout,
                      "Tag file (CSV) that says where the tags should be: list those heard elsewhere");
  command->add_option("--reach", options->reach_m, "With --layout: metres from which a tag in place is heard")
      ->capture_default_str()
      ->check(NumberBetween(0.1, 1000.0));
  command->callback([options, &exit_code] { exit_code = run_report_command(*options); });
}

}  // namespace forager::tools
