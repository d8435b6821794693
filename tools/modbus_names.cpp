#include "tools/modbus_names.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "boards/board.hpp"
#include "boards/modbus_bench.hpp"
#include "boards/run_clock.hpp"
#include "servo/modbus_register.hpp"
#include "tools/bench_session.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

using boards::ModbusDevice;
using boards::ModbusLine;
using servo::ModbusRegister;

enum class NamesTask : std::uint8_t { list, show, set };

struct NamesCommand {
  NamesTask task = NamesTask::list;
  std::string board;
  std::string device;
  std::vector<std::string> registers;
  double value = 0.0;
  bool arm = false;
  bool json = false;
};

std::string with_unit(double value, const ModbusRegister& quantity) {
  return fmt::format("{:.10g}{}{}", value, quantity.unit.empty() ? "" : " ", quantity.unit);
}

std::string place_of(const ModbusRegister& quantity) {
  constexpr const char* kTypes[] = {"u16", "i16", "u32", "i32", "f32"};
  std::string text =
      fmt::format("{} {} {}", quantity.table == servo::RegisterTable::input ? "input" : "holding",
                  quantity.address, kTypes[static_cast<std::size_t>(quantity.type)]);
  if (servo::words_of(quantity.type) > 1 && quantity.order == servo::WordOrder::low_first)
    text += " low word first";
  if (quantity.scale != 1.0) text += fmt::format(" x {:g}", quantity.scale);
  if (quantity.offset != 0.0) text += fmt::format(" + {:g}", quantity.offset);
  return text;
}

int list(const boards::Board& board, BenchOutput& out) {
  for (const ModbusLine& line : board.modbus)
    for (const ModbusDevice& device : line.devices) {
      out.line(fmt::format("{}: unit {} on {} ({})", device.name, device.unit, line.name, line.bus));
      for (const ModbusRegister& quantity : device.registers) {
        out.record({{"event", "register"},
                    {"line", line.name},
                    {"device", device.name},
                    {"unit", device.unit},
                    {"name", quantity.name},
                    {"place", place_of(quantity)},
                    {"measured_in", quantity.unit}});
        out.line(fmt::format("  {:<16} {}{}{}", quantity.name, place_of(quantity),
                             quantity.unit.empty() ? "" : ", ", quantity.unit));
      }
    }
  if (board.modbus.empty()) return complain_usage("board " + board.name + " has no [[modbus]] line");
  return kExitDone;
}

hal::Result<std::vector<ModbusRegister>> wanted(const NamesCommand& command, const ModbusDevice& device) {
  if (command.registers.empty()) return device.registers;
  std::vector<ModbusRegister> registers;
  for (const std::string& name : command.registers) {
    const ModbusRegister* known = device.find(name);
    std::string there;
    for (const ModbusRegister& quantity : device.registers)
      there += (there.empty() ? "It has " : ", ") + quantity.name;
    if (known == nullptr)
      return hal::fail(hal::ErrorCode::invalid_argument, "modbus device " + device.name, "find " + name,
                       "it declares no register of this name", there);
    registers.push_back(*known);
  }
  return registers;
}

int show(const ModbusDevice& device, const std::vector<ModbusRegister>& registers, hal::Modbus& bus,
         BenchOutput& out) {
  for (const ModbusRegister& quantity : registers) {
    const auto value = servo::read(bus, device.unit, quantity);
    if (!value) return complain(value.error());
    out.record({{"event", "value"},
                {"device", device.name},
                {"name", quantity.name},
                {"value", *value},
                {"measured_in", quantity.unit}});
    out.line(fmt::format("{:<16} {}", quantity.name, with_unit(*value, quantity)));
  }
  return kExitDone;
}

// Says what was really written: registers hold whole numbers.
int set(const ModbusDevice& device, const ModbusRegister& quantity, double value, hal::Modbus& bus,
        BenchOutput& out) {
  const auto raw = servo::encode(quantity, value);
  if (!raw) return complain(raw.error());
  const auto nearest = servo::decode(quantity, *raw);
  if (!nearest) return complain(nearest.error());
  if (const auto written = servo::write(bus, device.unit, quantity, value); !written)
    return complain(written.error());
  out.record({{"event", "written"},
              {"device", device.name},
              {"name", quantity.name},
              {"value", *nearest},
              {"measured_in", quantity.unit}});
  out.line(fmt::format("{}: {} is {}; it stays until somebody writes again", device.name, quantity.name,
                       with_unit(*nearest, quantity)));
  return kExitDone;
}

int run(const NamesCommand& command) {
  if (command.task == NamesTask::set && !command.arm)
    return complain_not_armed("the device may act on what is written");
  const auto board = boards::load_board(command.board);
  if (!board) return complain(board.error());
  BenchOutput out(command.json);
  if (command.task == NamesTask::list) return list(*board, out);
  const auto unit = boards::find_modbus(board->modbus, command.device);
  if (!unit) return complain(unit.error());
  const auto registers = wanted(command, *unit->device);
  if (!registers) return complain(registers.error());
  const auto clock = unit->line->bus == "sim" ? boards::make_virtual_clock() : boards::make_real_clock(1.0);
  const auto bus = boards::open_modbus(*unit->line, *clock);
  if (!bus) return complain(bus.error());
  if (command.task == NamesTask::show) return show(*unit->device, *registers, **bus, out);
  return set(*unit->device, registers->front(), command.value, **bus, out);
}

CLI::App* add_task(CLI::App& modbus, const char* name, const char* what, NamesTask task,
                   const std::shared_ptr<NamesCommand>& command, int& exit_code) {
  command->task = task;
  CLI::App* sub = modbus.add_subcommand(name, what);
  sub->add_option("--board", command->board, "Board file with [[modbus]]")->required();
  sub->add_flag("--json", command->json, "JSON lines on stdout");
  sub->callback([command, &exit_code] { exit_code = run(*command); });
  if (task == NamesTask::list) return sub;
  sub->add_option("device", command->device, "Name of the board file, or LINE.DEVICE")->required();
  return sub;
}

}  // namespace

void add_modbus_names(CLI::App& modbus, int& exit_code) {
  add_task(modbus, "list", "Devices and registers that a board file names; asks none", NamesTask::list,
           std::make_shared<NamesCommand>(), exit_code);
  const auto shown = std::make_shared<NamesCommand>();
  add_task(modbus, "show", "Values of a device's registers, by name", NamesTask::show, shown, exit_code)
      ->add_option("registers", shown->registers, "Which; all of them without");
  const auto written = std::make_shared<NamesCommand>();
  CLI::App* sub = add_task(modbus, "set", "Write a register by name, in the unit of its manual",
                           NamesTask::set, written, exit_code);
  written->registers.emplace_back();
  sub->add_option("register", written->registers.front(), "Name of the register")->required();
  sub->add_option("value", written->value, "In its unit")->required()->check(NumberBetween(-3.5e38, 3.5e38));
  sub->add_flag("--arm", written->arm, "Yes, the device may act on it");
}

}  // namespace forager::tools
