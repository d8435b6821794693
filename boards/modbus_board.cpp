#include "boards/modbus_board.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace forager::boards {
namespace {

using servo::ModbusRegister;
using servo::RegisterTable;
using servo::RegisterType;
using servo::WordOrder;

constexpr Range kWord{0, 65535};

template <class T>
struct Named {
  std::string_view name;
  T value;
};
constexpr std::array kTypes{
    Named<RegisterType>{"u16", RegisterType::u16}, Named<RegisterType>{"i16", RegisterType::i16},
    Named<RegisterType>{"u32", RegisterType::u32}, Named<RegisterType>{"i32", RegisterType::i32},
    Named<RegisterType>{"f32", RegisterType::f32}};
constexpr std::array kKinds{Named<ModbusKind>{"registers", ModbusKind::registers},
                            Named<ModbusKind>{"battery", ModbusKind::battery},
                            Named<ModbusKind>{"charger", ModbusKind::charger}};

template <class Table>
auto value_of(const Table& table, std::string_view name) {
  const auto found =
      std::find_if(table.begin(), table.end(), [&](const auto& one) { return one.name == name; });
  return found == table.end() ? table.front().value : found->value;
}

ModbusRegister read_register(ConfigReader& table) {
  ModbusRegister quantity;
  table.require("name", "what it holds, such as name = \"voltage\"");
  quantity.name = table.text("name", "");
  read_register_map(table, quantity);
  return quantity;
}

void want(ConfigReader& table, const ModbusDevice& device, std::string_view quantity) {
  if (device.find(quantity) == nullptr)
    table.complain("register",
                   fmt::format("has no \"{}\", which a {} needs", quantity, to_string(device.kind)),
                   "Declare it as [[modbus.device.register]], from the device's manual.");
}

void read_charger(ConfigReader& table, ModbusDevice& device) {
  const auto bit = [&table](std::string_view key, std::uint8_t fallback) {
    return static_cast<std::uint8_t>(table.integer(key, fallback, {0, 15}));
  };
  device.poll = table.duration("poll_ms", std::chrono::milliseconds(200), {10, 60000});
  device.stale = table.duration("stale_ms", std::chrono::seconds(1), {10, 600000});
  device.enable_coil = static_cast<std::uint16_t>(table.integer("enable_coil", 0, kWord));
  device.docked_bit = bit("docked_bit", device.docked_bit);
  device.charging_bit = bit("charging_bit", device.charging_bit);
  device.fault_bit = bit("fault_bit", device.fault_bit);
  want(table, device, "status");
  const ModbusRegister* status = device.find("status");
  if (status != nullptr &&
      (status->type != RegisterType::u16 || status->scale != 1.0 || status->offset != 0.0))
    table.complain("register", "\"status\" of a charger must be a plain u16", "Its bits are what counts.");
}

ModbusDevice read_device(ConfigReader& table) {
  ModbusDevice device;
  table.require("name", "a short name, such as name = \"battery\"");
  table.require("unit", "its number on the line, 1 to 247");
  device.name = table.text("name", "");
  device.unit = static_cast<std::uint8_t>(table.integer("unit", 1, {1, 247}));
  device.kind = value_of(kKinds, table.choice("kind", "registers", {"registers", "battery", "charger"}));
  for (ConfigReader& quantity : table.tables("register")) {
    ModbusRegister read = read_register(quantity);
    if (device.find(read.name) != nullptr) quantity.complain("name", "stands twice", "Names are unique.");
    device.registers.push_back(std::move(read));
  }
  if (device.kind == ModbusKind::charger) {
    read_charger(table, device);
  } else if (device.kind == ModbusKind::battery) {
    device.poll = table.duration("poll_ms", device.poll, {10, 60000});
    device.stale = table.duration("stale_ms", device.stale, {10, 600000});
    want(table, device, "voltage");
    want(table, device, "charge");
  }
  return device;
}

ModbusLine read_line(ConfigReader& table) {
  ModbusLine line;
  table.require("name", "a short name, such as name = \"power\"");
  table.require("bus", "a serial port, HOST:PORT or \"sim\", such as bus = \"/dev/ttyUSB0\"");
  line.name = table.text("name", "");
  line.bus = table.text("bus", "");
  line.line.baud = static_cast<std::uint32_t>(table.integer("baud", line.line.baud, {1200, 921600}));
  const std::string parity = table.choice("parity", "even", {"none", "even", "odd"});
  line.line.parity = parity == "none"   ? hal::Parity::none
                     : parity == "even" ? hal::Parity::even
                                        : hal::Parity::odd;
  line.line.stop_bits = static_cast<std::uint8_t>(table.integer("stop_bits", line.line.stop_bits, {1, 2}));
  line.timeout = table.duration("timeout_ms", line.timeout, {1, 10000});
  for (ConfigReader& device : table.tables("device")) {
    ModbusDevice read = read_device(device);
    if (line.find(read.name) != nullptr) device.complain("name", "stands twice", "Names are unique.");
    line.devices.push_back(std::move(read));
  }
  return line;
}

std::optional<ModbusRegister> optional_register(const ModbusDevice& device, std::string_view quantity) {
  const ModbusRegister* known = device.find(quantity);
  return known != nullptr ? std::optional(*known) : std::nullopt;
}

hal::Failure wrong_device(const ModbusDevice& device, std::string_view wanted) {
  return hal::fail(hal::ErrorCode::invalid_argument, "modbus device " + device.name, "open",
                   fmt::format("is no {} with the registers it needs", wanted));
}

}  // namespace

std::string_view to_string(ModbusKind kind) {
  for (const auto& known : kKinds)
    if (known.value == kind) return known.name;
  return "unknown";
}

const ModbusRegister* ModbusDevice::find(std::string_view quantity) const {
  const auto found =
      std::find_if(registers.begin(), registers.end(), [&](const auto& r) { return r.name == quantity; });
  return found == registers.end() ? nullptr : &*found;
}

const ModbusDevice* ModbusLine::find(std::string_view device) const {
  const auto found =
      std::find_if(devices.begin(), devices.end(), [&](const auto& d) { return d.name == device; });
  return found == devices.end() ? nullptr : &*found;
}

void read_register_map(ConfigReader& table, ModbusRegister& quantity) {
  table.require("address", "its number on the wire, from 0: 40001 of a manual is 0");
  quantity.address = static_cast<std::uint16_t>(table.integer("address", 0, kWord));
  const bool input = quantity.table == RegisterTable::input;
  quantity.table = table.choice("table", input ? "input" : "holding", {"holding", "input"}) == "input"
                       ? RegisterTable::input
                       : RegisterTable::holding;
  quantity.type = value_of(kTypes, table.choice("type", "u16", {"u16", "i16", "u32", "i32", "f32"}));
  if (table.choice("word_order", "high_first", {"high_first", "low_first"}) == "low_first")
    quantity.order = WordOrder::low_first;
  quantity.scale = table.number("scale", 1.0, {-1e9, 1e9});
  quantity.offset = table.number("offset", 0.0, {-1e9, 1e9});
  quantity.unit = table.text("unit", "");
  if (const auto possible = servo::check(quantity); !possible)
    table.complain("scale", "and address make no register: " + possible.error().detail, "See the manual.");
}

std::vector<ModbusLine> read_modbus_board(ConfigReader& top) {
  std::vector<ModbusLine> lines;
  for (ConfigReader& table : top.tables("modbus")) lines.push_back(read_line(table));
  return lines;
}

hal::Result<servo::ModbusBattery> make_battery(hal::Modbus& bus, const ModbusDevice& device) {
  const ModbusRegister* voltage = device.find("voltage");
  const ModbusRegister* charge = device.find("charge");
  if (device.kind != ModbusKind::battery || voltage == nullptr || charge == nullptr)
    return wrong_device(device, "battery");
  return servo::ModbusBattery::create(bus, {.unit = device.unit,
                                            .voltage = *voltage,
                                            .charge = *charge,
                                            .current = optional_register(device, "current"),
                                            .temperature = optional_register(device, "temperature"),
                                            .poll_interval = device.poll,
                                            .stale_after = device.stale});
}

hal::Result<servo::ModbusCharger> make_charger(hal::Modbus& bus, const ModbusDevice& device) {
  const ModbusRegister* status = device.find("status");
  if (device.kind != ModbusKind::charger || status == nullptr) return wrong_device(device, "charger");
  return servo::ModbusCharger::create(bus, {.unit = device.unit,
                                            .status = *status,
                                            .docked_bit = device.docked_bit,
                                            .charging_bit = device.charging_bit,
                                            .fault_bit = device.fault_bit,
                                            .enable_coil = device.enable_coil,
                                            .current = optional_register(device, "current"),
                                            .poll_interval = device.poll,
                                            .stale_after = device.stale});
}

}  // namespace forager::boards
