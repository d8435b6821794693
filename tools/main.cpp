#include <CLI/CLI.hpp>

#include "tools/cli_style.hpp"
#include "tools/cmd_emulate.hpp"
#include "tools/cmd_report.hpp"
#include "tools/cmd_run.hpp"

int main(int argc, char** argv) {
  using namespace forager::tools;
  CLI::App app{"RFID tag reads into motion: fly inventory missions, emulate and test their devices",
               "forager"};
  app.set_version_flag("--version", FORAGER_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 1 device or I/O failure, 2 usage, 3 not built in or not present, 4 a check "
      "failed.");
  int exit_code = kExitDone;
  add_run_command(app, exit_code);
  add_report_command(app, exit_code);
  add_emulate_command(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitDone : kExitUsage;
  }
  return exit_code;
}
