#include "tools/cmd_serial.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "boards/board.hpp"
#include "boards/serial_bench.hpp"
#include "tools/bench_session.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"
#include "tools/serial_session.hpp"

namespace forager::tools {
namespace {

using Command = std::shared_ptr<SerialCommand>;

int run_list(const SerialCommand& command, const boards::BenchBoard& names) {
  BenchOutput out(command.json);
  const auto ports = boards::serial_ports();
  for (const auto& port : ports) {
    out.record({{"event", "port"},
                {"device", port.device},
                {"by_id", port.by_id},
                {"driver", port.driver},
                {"product", port.product},
                {"serial", port.serial}});
    out.line(fmt::format("{:<16} {:<12} {}{}", port.device, port.driver, port.product,
                         port.serial.empty() ? "" : ", serial " + port.serial));
    for (const std::string& name : port.by_id) out.line(fmt::format("  {}", name));
  }
  if (ports.empty()) fmt::print(stderr, "forager: this machine has no serial port\n");
  for (const boards::BenchSerial& line : names.serials) {
    const std::string settings = to_string(boards::settings_of(line));
    out.record({{"event", "name"}, {"name", line.name}, {"device", line.port}, {"line", settings}});
    out.line(fmt::format("{} is {} at {}", line.name, line.port, settings));
  }
  return kExitDone;
}

int run(SerialCommand command) {
  boards::BenchBoard names;
  if (!command.board.empty()) {
    auto board = boards::load_board(command.board);
    if (!board) return complain(board.error());
    names = std::move(board->bench);
  }
  if (command.task == SerialTask::list) return run_list(command, names);
  if (command.task == SerialTask::terminal && !command.arm)
    return complain_not_armed("what you type will be sent");
  const auto line = boards::find_serial(names, command.device);
  if (!line) return complain(line.error());
  command.device = line->port;
  const auto settings = settings_of(command, boards::settings_of(*line));
  if (!settings) return complain(settings.error());
  switch (command.task) {
    case SerialTask::loopback:
      return run_serial_loopback(command, *settings);
    case SerialTask::baud:
      return run_serial_baud(command, *settings);
    case SerialTask::list:
    case SerialTask::watch:
    case SerialTask::terminal:
    case SerialTask::echo:
      break;
  }
  return run_serial_watch(command, *settings);
}

CLI::App* add_task(CLI::App& serial, const char* name, const char* what, SerialTask task, Command& command,
                   int& exit_code) {
  command = std::make_shared<SerialCommand>();
  command->task = task;
  CLI::App* sub = serial.add_subcommand(name, what);
  sub->add_option("--board", command->board, "Board file that names serial lines");
  sub->add_flag("--json", command->json, "JSON lines on stdout");
  sub->callback([command, &exit_code] { exit_code = run(*command); });
  if (task == SerialTask::list) return sub;
  sub->add_option("device", command->device,
                  "Name of the board file, or a port, best as /dev/serial/by-id/...")
      ->required();
  if (task != SerialTask::baud)
    sub->add_option("--baud", command->baud, "Bits a second; the board file's, or 115200")
        ->check(WholeNumber(12'000'000));
  sub->add_option("--format", command->format, "Data bits, parity, stop bits; the board file's, or 8N1");
  sub->add_flag("--rts-cts", command->hardware_flow, "Hardware flow control");
  return sub;
}

CLI::Option* add_for(CLI::App* sub, const Command& command) {
  return sub->add_option("--for", command->for_s, "Stop after so long, such as 10s; else at Ctrl-C")
      ->transform(TimeSpan(0.01, 1e6));
}

}  // namespace

void add_serial_command(CLI::App& app, int& exit_code) {
  CLI::App* serial =
      app.add_subcommand("serial", "Serial ports: which there are, what comes, does the line work");
  serial->require_subcommand(1);
  Command command;
  add_task(*serial, "list", "Ports with their lasting names; opens none", SerialTask::list, command,
           exit_code);
  CLI::App* sub =
      add_task(*serial, "watch", "Print what comes; sends nothing", SerialTask::watch, command, exit_code);
  add_for(sub, command);
  sub->add_flag("--hex", command->hex, "In hex with the time");
  sub = add_task(*serial, "terminal", "Print what comes, send what is typed or piped in",
                 SerialTask::terminal, command, exit_code);
  add_for(sub, command);
  sub->add_flag("--hex", command->hex, "What comes in hex with the time");
  sub->add_flag("--arm", command->arm, "Yes, whatever hangs on that line may act on what is sent");
  sub = add_task(*serial, "echo", "Send everything back that comes, for a loopback test at the far end",
                 SerialTask::echo, command, exit_code);
  add_for(sub, command);
  sub->add_flag("--hex", command->hex, "In hex with the time");
  sub = add_task(*serial, "loopback", "With TX wired to RX: send a pattern and compare what comes back",
                 SerialTask::loopback, command, exit_code);
  sub->add_option("--bytes", command->bytes, "How many")
      ->capture_default_str()
      ->check(WholeNumber(100'000'000));
  sub->add_option("--seed", command->seed, "Of the pattern")->capture_default_str()->check(WholeNumber());
  sub = add_task(*serial, "baud", "Listen at one rate after the other: at which does what comes make sense?",
                 SerialTask::baud, command, exit_code);
  command->for_s = 1.0;
  sub->add_option("--for", command->for_s, "At each rate")
      ->capture_default_str()
      ->transform(TimeSpan(0.01, 600.0));
  sub->add_option("--rates", command->rates, "Such as 9600,57600; else the usual ones")
      ->delimiter(',')
      ->check(WholeNumber(12'000'000));
}

}  // namespace forager::tools
