#include "tools/cmd_modbus.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "boards/modbus_bench.hpp"
#include "tools/bench_session.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"
#include "tools/modbus_names.hpp"

namespace forager::tools {
namespace {

enum class ModbusTask : std::uint8_t { read, write, coil, scan };

struct ModbusCommand {
  ModbusTask task = ModbusTask::read;
  boards::ModbusPlace place;
  std::string parity = "even";
  double timeout_s = 0.2;
  unsigned unit = 1;
  unsigned address = 0;
  unsigned count = 1;
  bool input = false;
  std::vector<unsigned> values;
  std::string level;
  bool arm = false;
  unsigned first = 1;
  unsigned last = 247;
  bool json = false;
};

int read_registers(const ModbusCommand& command, hal::Modbus& bus) {
  std::vector<std::uint16_t> values(command.count);
  const auto unit = static_cast<std::uint8_t>(command.unit);
  const auto address = static_cast<std::uint16_t>(command.address);
  const auto done =
      command.input ? bus.read_input(unit, address, values) : bus.read_holding(unit, address, values);
  if (!done) return complain(done.error());
  BenchOutput out(command.json);
  out.record({{"event", "registers"},
              {"unit", command.unit},
              {"table", command.input ? "input" : "holding"},
              {"address", command.address},
              {"values", values}});
  for (std::size_t i = 0; i < values.size(); ++i)
    out.line(fmt::format("{:>5}  {:>5}  0x{:04x}  {:>6}", command.address + i, values[i], values[i],
                         static_cast<std::int16_t>(values[i])));
  return kExitDone;
}

int write_registers(const ModbusCommand& command, hal::Modbus& bus) {
  const std::vector<std::uint16_t> values(command.values.begin(), command.values.end());
  const auto unit = static_cast<std::uint8_t>(command.unit);
  const auto address = static_cast<std::uint16_t>(command.address);
  if (const auto done = bus.write_holding(unit, address, values); !done) return complain(done.error());
  BenchOutput out(command.json);
  out.record(
      {{"event", "written"}, {"unit", command.unit}, {"address", command.address}, {"values", values}});
  out.line(fmt::format("unit {}, holding register {}: {} written; it stays until somebody writes again",
                       command.unit, command.address, fmt::join(values, " ")));
  return kExitDone;
}

int write_coil(const ModbusCommand& command, hal::Modbus& bus) {
  const auto done = bus.write_coil(static_cast<std::uint8_t>(command.unit),
                                   static_cast<std::uint16_t>(command.address), command.level == "on");
  if (!done) return complain(done.error());
  BenchOutput out(command.json);
  out.record({{"event", "coil"},
              {"unit", command.unit},
              {"address", command.address},
              {"on", command.level == "on"}});
  out.line(fmt::format("unit {}, coil {}: {}; it stays until somebody writes again", command.unit,
                       command.address, command.level));
  return kExitDone;
}

// A unit that answers is there, whatever it says: an exception is an answer, too.
int scan(const ModbusCommand& command, hal::Modbus& bus) {
  const StopSignal signals;
  BenchOutput out(command.json);
  unsigned found = 0;
  for (unsigned unit = command.first; unit <= command.last && !StopSignal::raised(); ++unit) {
    out.live({fmt::format("unit {} of {} to {}, {} found", unit, command.first, command.last, found)});
    std::uint16_t value = 0;
    const auto done = bus.read_holding(static_cast<std::uint8_t>(unit),
                                       static_cast<std::uint16_t>(command.address), std::span(&value, 1));
    if (!done && done.error().code == hal::ErrorCode::timeout) continue;
    const bool answered = done || done.error().code == hal::ErrorCode::refused ||
                          done.error().code == hal::ErrorCode::busy ||
                          done.error().code == hal::ErrorCode::protocol;
    if (!answered) return complain(done.error());
    ++found;
    const std::string says =
        done ? fmt::format("register {} is {}", command.address, value) : done.error().detail;
    out.record({{"event", "unit"}, {"unit", unit}, {"says", says}});
    out.line(fmt::format("unit {:>3}  {}", unit, says));
  }
  if (found > 0) return StopSignal::raised() ? kExitFailure : kExitDone;
  fmt::print(stderr,
             "forager: {}: nobody answers from unit {} to {}: no power, A and B swapped, another baud rate "
             "or parity, "
             "or a longer --timeout is needed\n",
             bus.name(), command.first, command.last);
  return kExitCheckFailed;
}

int run(ModbusCommand& command) {
  const bool writes = command.task == ModbusTask::write || command.task == ModbusTask::coil;
  if (writes && !command.arm) return complain_not_armed("the device may act on what is written");
  if (command.task == ModbusTask::scan && command.first > command.last)
    return complain_usage(fmt::format("--from {} is behind --to {}", command.first, command.last));
  command.place.timeout = hal::from_seconds(command.timeout_s);
  command.place.parity = command.parity == "none" ? 'N' : command.parity == "odd" ? 'O' : 'E';
  const auto bus = boards::open_modbus_bench(command.place);
  if (!bus) return complain(bus.error());
  switch (command.task) {
    case ModbusTask::write:
      return write_registers(command, **bus);
    case ModbusTask::coil:
      return write_coil(command, **bus);
    case ModbusTask::scan:
      return scan(command, **bus);
    case ModbusTask::read:
      break;
  }
  return read_registers(command, **bus);
}

using Command = std::shared_ptr<ModbusCommand>;

CLI::App* add_task(CLI::App& modbus, const char* name, const char* what, ModbusTask task, Command& command,
                   int& exit_code) {
  command = std::make_shared<ModbusCommand>();
  command->task = task;
  CLI::App* sub = modbus.add_subcommand(name, what);
  sub->add_option("bus", command->place.bus, "Serial port, HOST:PORT, or sim for an emulated device")
      ->required();
  sub->add_option("--baud", command->place.baud, "Of a serial port")
      ->capture_default_str()
      ->check(WholeNumber(1200, 921600));
  sub->add_option("--parity", command->parity, "Of a serial port")
      ->capture_default_str()
      ->check(CLI::IsMember({"none", "even", "odd"}));
  sub->add_option("--timeout", command->timeout_s, "For an answer, such as 200ms")
      ->capture_default_str()
      ->transform(TimeSpan(0.001, 60.0));
  sub->add_flag("--json", command->json, "JSON lines on stdout");
  sub->callback([command, &exit_code] { exit_code = run(*command); });
  if (task != ModbusTask::scan)
    sub->add_option("--unit", command->unit, "Number of the device")
        ->capture_default_str()
        ->check(WholeNumber(247));
  return sub;
}

void add_address(CLI::App* sub, const Command& command) {
  sub->add_option("address", command->address, "Of the first one, counted from 0: a manual's 40001 is 0")
      ->required()
      ->check(WholeNumber(65535));
}

void add_arm(CLI::App* sub, const Command& command) {
  sub->add_flag("--arm", command->arm, "Yes, the device may act on it");
}

}  // namespace

void add_modbus_command(CLI::App& app, int& exit_code) {
  CLI::App* modbus = app.add_subcommand("modbus", "Read and write registers of Modbus devices, find devices");
  modbus->require_subcommand(1);
  add_modbus_names(*modbus, exit_code);
  Command command;
  CLI::App* sub = add_task(*modbus, "read", "Read registers", ModbusTask::read, command, exit_code);
  add_address(sub, command);
  sub->add_option("--count", command->count, "How many")->capture_default_str()->check(WholeNumber(1, 125));
  sub->add_flag("--input", command->input, "Input registers, not holding registers");
  sub = add_task(*modbus, "write", "Write holding registers", ModbusTask::write, command, exit_code);
  add_address(sub, command);
  sub->add_option("values", command->values, "What to write, one after the other")
      ->required()
      ->check(WholeNumber(65535));
  add_arm(sub, command);
  sub = add_task(*modbus, "coil", "Switch a coil", ModbusTask::coil, command, exit_code);
  add_address(sub, command);
  sub->add_option("level", command->level, "on or off")->required()->check(CLI::IsMember({"on", "off"}));
  add_arm(sub, command);
  sub = add_task(*modbus, "scan", "Ask one unit after the other whether it is there", ModbusTask::scan,
                 command, exit_code);
  sub->add_option("--from", command->first, "First unit")->capture_default_str()->check(WholeNumber(1, 247));
  sub->add_option("--to", command->last, "Last unit")->capture_default_str()->check(WholeNumber(1, 247));
  sub->add_option("--register", command->address, "Holding register that is read")
      ->capture_default_str()
      ->check(WholeNumber(65535));
}

}  // namespace forager::tools
