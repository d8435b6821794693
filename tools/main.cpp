#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"
#include "tools/cmd_bench.hpp"
#include "tools/cmd_brake.hpp"
#include "tools/cmd_calibrate.hpp"
#include "tools/cmd_depth.hpp"
#include "tools/cmd_doctor.hpp"
#include "tools/cmd_drive.hpp"
#include "tools/cmd_emulate.hpp"
#include "tools/cmd_esc.hpp"
#include "tools/cmd_generate.hpp"
#include "tools/cmd_gpio.hpp"
#include "tools/cmd_guard.hpp"
#include "tools/cmd_hid.hpp"
#include "tools/cmd_i2c.hpp"
#include "tools/cmd_mavlink.hpp"
#include "tools/cmd_modbus.hpp"
#include "tools/cmd_pwm.hpp"
#include "tools/cmd_reader.hpp"
#include "tools/cmd_replay.hpp"
#include "tools/cmd_report.hpp"
#include "tools/cmd_reproduce.hpp"
#include "tools/cmd_run.hpp"
#include "tools/cmd_selftest.hpp"
#include "tools/cmd_serial.hpp"
#include "tools/cmd_servo.hpp"
#include "tools/cmd_stress.hpp"
#include "tools/cmd_usb.hpp"
#include "tools/completion.hpp"
#include "tools/manual_page.hpp"

namespace {

// Started with one of them closed (>&-), the next file opened would take its number, and what is meant for
// the terminal would go into the inventory.
void keep_standard_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(descriptor, F_GETFD) < 0) static_cast<void>(open("/dev/null", O_RDONLY));
}

// What the shell asks for while a command line is being typed: tools/forager.bash-completion.
int print_completions(const CLI::App& app, int argc, char** argv) {
  const std::vector<std::string> words(argv + 2, argv + argc);
  for (const std::string& line : forager::tools::completions(app, words)) std::puts(line.c_str());
  return forager::tools::kExitDone;
}

int run_command(int argc, char** argv) {
  using namespace forager::tools;
  keep_standard_descriptors();
  // Whoever reads our output may go away; that must not end a flight.
  std::signal(SIGPIPE, SIG_IGN);
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
  add_replay_command(app, exit_code);
  add_drive_command(app, exit_code);
  add_emulate_command(app, exit_code);
  add_doctor_command(app, exit_code);
  add_selftest_command(app, exit_code);
  add_gpio_command(app, exit_code);
  add_pwm_command(app, exit_code);
  add_i2c_command(app, exit_code);
  add_servo_command(app, exit_code);
  add_brake_command(app, exit_code);
  add_esc_command(app, exit_code);
  add_guard_command(app, exit_code);
  add_reader_command(app, exit_code);
  add_mavlink_command(app, exit_code);
  add_depth_command(app, exit_code);
  add_serial_command(app, exit_code);
  add_modbus_command(app, exit_code);
  add_usb_command(app, exit_code);
  add_hid_command(app, exit_code);
  add_bench_command(app, exit_code);
  add_stress_command(app, exit_code);
  add_reproduce_command(app, exit_code);
  add_calibrate_command(app, exit_code);
  add_generate_command(app, exit_code);
  add_manual_command(app, FORAGER_VERSION, exit_code);
  if (argc > 1 && std::string_view(argv[1]) == "__complete") return print_completions(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // help and version
    return complain_about_arguments(app, error, argc, argv);
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run_command(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "forager: %s\n", error.what());
    return forager::tools::kExitFailure;
  }
}
