#pragma once

#include <string>

namespace CLI {
class App;
}

namespace forager::tools {

struct ReportOptions {
  std::string database;  // inventory file, or the folder of a run
  std::string csv;       // write the items here, "-" for stdout instead of the table; empty: don't
  bool json = false;     // JSON lines on stdout instead of the table
  bool items = false;    // list every item after the summary
  std::string layout;    // tag file to hold the inventory against; empty: none
  double reach_m = 5.0;  // farther from its listed place a tag is not at it
};

// Prints the facts of a run and a summary of its inventory. Gives an exit code of tools/cli_style.hpp.
int run_report_command(const ReportOptions& options);

// Adds `forager report`; exit_code gets its result when it runs.
void add_report_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
