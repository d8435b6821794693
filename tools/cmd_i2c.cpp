#include "tools/cmd_i2c.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/bench_session.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

constexpr std::uint8_t kFirst = 0x08;  // the rest is reserved (I2C-bus specification, table 4)
constexpr std::uint8_t kLast = 0x77;

struct ByteText : CLI::Validator {
  ByteText() {
    func_ = [](const std::string& text) {
      return boards::parse_number(text, 255)
                 ? std::string()
                 : fmt::format("'{}' is not a byte, 0 to 255 or 0x00 to 0xff", text);
    };
  }
};

std::byte byte_of(const std::string& text) {
  return static_cast<std::byte>(boards::parse_number(text, 255).value_or(0));
}

std::string hex_of(const std::vector<std::byte>& bytes) {
  std::vector<std::string> texts;
  texts.reserve(bytes.size());
  for (const std::byte byte : bytes) texts.push_back(fmt::format("{:02x}", std::to_integer<unsigned>(byte)));
  return fmt::format("{}", fmt::join(texts, " "));
}

int list_buses(BenchPlace& place, BenchOutput& output) {
  const auto buses = place.machine->i2c_buses();
  for (const std::string& bus : buses) {
    output.record({{"event", "bus"}, {"bus", bus}});
    output.line(bus);
  }
  if (buses.empty())
    output.line("this machine has no I2C bus; dtparam=i2c_arm=on, and sudo modprobe i2c-dev");
  for (const boards::BenchChip& chip : place.board.bench.chips) {
    output.record({{"event", "name"}, {"name", chip.name}, {"bus", chip.bus}, {"address", chip.address}});
    output.line(fmt::format("{} is 0x{:02x} of {}", chip.name, chip.address, chip.bus));
  }
  return kExitDone;
}

// What the board file has at an address; empty: nothing.
std::string known_at(const boards::BenchBoard& names, const std::string& bus, std::uint8_t address) {
  for (const boards::BenchChip& chip : names.chips)
    if (chip.bus == bus && chip.address == address) return chip.name;
  for (const boards::BenchServo& servo : names.servos)
    if (servo.place.backend == boards::PwmBackend::pca9685 && servo.place.bus == bus &&
        servo.place.address == address)
      return "the PCA9685 of " + servo.name;
  return {};
}

// Reads one byte from every address, which is what a chip expects least harm from.
int scan(const I2cCommand& command, BenchPlace& place, BenchOutput& output) {
  const std::string bus = command.target.board == "sim" ? "sim" : boards::i2c_path(command.bus);
  const auto opened = place.machine->open_i2c(bus, hal::from_seconds(command.timeout_s));
  if (!opened) return complain(opened.error());
  int found = 0;
  for (std::uint8_t address = kFirst; address <= kLast; ++address) {
    std::byte byte{};
    const auto read = (*opened)->read(address, std::span(&byte, 1));
    if (!read && read.error().code == hal::ErrorCode::no_ack) continue;
    const bool taken = !read && read.error().code == hal::ErrorCode::busy;  // by a driver of the kernel
    if (!read && !taken) return complain(read.error());
    ++found;
    const std::string name = known_at(place.board.bench, bus, address);
    output.record({{"event", "chip"},
                   {"bus", bus},
                   {"address", address},
                   {"driver_of_kernel", taken},
                   {"board_name", name}});
    output.line(fmt::format("0x{:02x}{}{}", address, taken ? " held by a driver of the kernel" : " answers",
                            name.empty() ? "" : ", here called " + name));
  }
  output.record({{"event", "scanned"}, {"bus", bus}, {"chips", found}});
  output.line(fmt::format("{} {} on {}", found, found == 1 ? "chip" : "chips", bus));
  return kExitDone;
}

int read_chip(const I2cCommand& command, const boards::BenchChip& chip, hal::I2c& bus, BenchOutput& output) {
  std::vector<std::byte> bytes(command.count);
  const std::byte reg = byte_of(command.reg);
  const auto read = command.reg.empty() ? bus.read(chip.address, bytes)
                                        : bus.write_read(chip.address, std::span(&reg, 1), bytes);
  if (!read) return complain(read.error());
  std::vector<unsigned> numbers;
  numbers.reserve(bytes.size());
  for (const std::byte byte : bytes) numbers.push_back(std::to_integer<unsigned>(byte));
  output.record({{"event", "read"}, {"chip", chip.name}, {"register", command.reg}, {"bytes", numbers}});
  output.line(
      fmt::format("{}{}: {}", chip.name, command.reg.empty() ? "" : " from " + command.reg, hex_of(bytes)));
  return kExitDone;
}

int write_chip(const I2cCommand& command, const boards::BenchChip& chip, hal::I2c& bus, BenchOutput& output) {
  std::vector<std::byte> bytes;
  for (const std::string& text : command.bytes) bytes.push_back(byte_of(text));
  if (const auto written = bus.write(chip.address, bytes); !written) return complain(written.error());
  output.record({{"event", "written"}, {"chip", chip.name}, {"count", bytes.size()}});
  output.line(fmt::format("{}: wrote {}", chip.name, hex_of(bytes)));
  return kExitDone;
}

CLI::App* add_task(CLI::App& i2c, const char* name, const char* what, I2cTask task,
                   const std::shared_ptr<I2cCommand>& command, int& exit_code) {
  command->task = task;
  CLI::App* sub = i2c.add_subcommand(name, what);
  add_target_options(sub, command->target, false);
  if (task != I2cTask::list)
    sub->add_option("--timeout", command->timeout_s, "Of one transfer; the kernel rounds up to 10 ms")
        ->transform(TimeSpan(0.001, 1.0));
  if (task == I2cTask::read || task == I2cTask::write)
    sub->add_option("CHIP", command->chip, "Name of the board file, or BUS@ADDRESS (1@0x40)")->required();
  sub->callback([command, &exit_code] { exit_code = run_i2c_command(*command); });
  return sub;
}

}  // namespace

int run_i2c_command(const I2cCommand& command) {
  if (command.task == I2cTask::write && !command.arm)
    return complain_not_armed(
        fmt::format("{} would be written {}, and keep it", command.chip, fmt::join(command.bytes, " ")));
  if (command.task == I2cTask::read && command.count == 0)
    return complain_usage("--count: reading nothing tells nothing");
  auto place = open_place(command.target);
  if (!place) return complain(place.error());
  BenchOutput output(command.target.json);
  if (command.task == I2cTask::list) return list_buses(*place, output);
  if (command.task == I2cTask::scan) return scan(command, *place, output);
  auto chip = boards::find_chip(place->board.bench, command.chip);
  if (!chip) return complain(chip.error());
  const auto bus = place->machine->open_i2c(
      chip->bus, chip->name == command.chip && chip->name.find('@') == std::string::npos
                     ? chip->timeout
                     : hal::from_seconds(command.timeout_s));
  if (!bus) return complain(bus.error());
  return command.task == I2cTask::read ? read_chip(command, *chip, **bus, output)
                                       : write_chip(command, *chip, **bus, output);
}

void add_i2c_command(CLI::App& app, int& exit_code) {
  CLI::App* i2c = app.add_subcommand("i2c", "Scan an I2C bus, read from and write to a chip");
  i2c->require_subcommand(1);
  add_task(*i2c, "list", "Buses of this machine, and names of the board file", I2cTask::list,
           std::make_shared<I2cCommand>(), exit_code);
  auto scanned = std::make_shared<I2cCommand>();
  add_task(*i2c, "scan", "Read a byte from every address, and say which answer", I2cTask::scan, scanned,
           exit_code)
      ->add_option("BUS", scanned->bus, "1, i2c-1 or /dev/i2c-1")
      ->capture_default_str();
  auto read = std::make_shared<I2cCommand>();
  CLI::App* sub = add_task(*i2c, "read", "Read bytes from a chip", I2cTask::read, read, exit_code);
  sub->add_option("--register", read->reg, "Write this register's number first")->check(ByteText());
  sub->add_option("--count", read->count, "Bytes")->capture_default_str()->check(WholeNumber(256));
  auto written = std::make_shared<I2cCommand>();
  sub = add_task(*i2c, "write", "Write bytes to a chip", I2cTask::write, written, exit_code);
  sub->add_option("BYTES", written->bytes, "Each 0 to 255 or 0x00 to 0xff")->required()->check(ByteText());
  sub->add_flag("--arm", written->arm, "Yes, what the chip drives may move");
}

}  // namespace forager::tools
