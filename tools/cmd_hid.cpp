#include "tools/cmd_hid.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "boards/board.hpp"
#include "boards/wedge_bench.hpp"
#include "tools/cli_style.hpp"
#include "tools/plug_session.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

constexpr hal::Duration kLookAgain = 250ms;  // HID tells nobody when something is plugged in

// HID usage tables 1.21, generic desktop page.
std::string usage_text(const hal::HidDeviceFacts& device) {
  if (device.usage_page == 0x0001 && device.usage == 0x0006) return "keyboard";
  if (device.usage_page == 0x0001 && device.usage == 0x0002) return "mouse";
  if (device.usage_page == 0) return "usage unknown";
  return fmt::format("usage {:04x}:{:04x}", device.usage_page, device.usage);
}

std::string text_of(const hal::HidDeviceFacts& device) {
  return fmt::format("{:<14} {:04x}:{:04x}  {}{}, {}{}", device.path.empty() ? "(no way in)" : device.path,
                     device.vendor, device.product,
                     device.product_name.empty() ? std::string("(says no name)") : device.product_name,
                     device.serial.empty() ? "" : ", serial " + device.serial, usage_text(device),
                     device.driver.empty() ? "" : ", driver " + device.driver);
}

Json json_of(const char* event, const hal::HidDeviceFacts& device) {
  return {{"event", event},
          {"path", device.path},
          {"vendor", fmt::format("{:04x}", device.vendor)},
          {"product", fmt::format("{:04x}", device.product)},
          {"manufacturer", device.manufacturer},
          {"name", device.product_name},
          {"serial", device.serial},
          {"usage_page", device.usage_page},
          {"usage", device.usage},
          {"driver", device.driver}};
}

int list_hid(PlugSession& session, hal::Hid& hid) {
  const auto devices = hid.devices();
  if (!devices) return complain(devices.error());
  for (const auto& device : *devices) {
    session.out.record(json_of("device", device));
    session.out.line(text_of(device));
    if (device.path.empty() && !device.driver.empty())
      session.out.line(
          fmt::format("  the kernel's driver {0} has it and lets nobody else in: rmmod {0}, or name it in "
                      "/etc/modprobe.d as blacklisted",
                      device.driver));
  }
  if (devices->empty()) fmt::print(stderr, "forager: no HID device that {} can see\n", hid.name());
  return kExitDone;
}

// What was there before, by path and name; whatever is new or gone is told.
class ComingsAndGoings {
 public:
  explicit ComingsAndGoings(std::vector<hal::HidDeviceFacts> devices) : known_(std::move(devices)) {}

  void look(PlugSession& session, hal::Instant now, std::vector<hal::HidDeviceFacts> devices) {
    for (const auto& device : known_)
      if (!has(devices, device)) tell(session, now, "left", "unplugged", device);
    for (const auto& device : devices)
      if (!has(known_, device)) tell(session, now, "arrived", "plugged in", device);
    known_ = std::move(devices);
  }

 private:
  static bool has(const std::vector<hal::HidDeviceFacts>& devices, const hal::HidDeviceFacts& wanted) {
    return std::ranges::any_of(devices, [&](const auto& it) {
      return it.path == wanted.path && it.vendor == wanted.vendor && it.product == wanted.product;
    });
  }
  static void tell(PlugSession& session, hal::Instant now, const char* event, const char* what,
                   const hal::HidDeviceFacts& device) {
    Json record = json_of(event, device);
    record["t_s"] = hal::to_seconds(now);
    session.out.record(record);
    session.out.line(fmt::format("{:9.3f} s  {:<10}  {}", hal::to_seconds(now), what, text_of(device)));
  }

  std::vector<hal::HidDeviceFacts> known_;
};

int watch_bus(PlugSession& session, hal::Hid& hid) {
  auto first = hid.devices();
  if (!first) return complain(first.error());
  ComingsAndGoings known(*std::move(first));
  BenchLoop loop(*session.clock, kLookAgain);
  std::optional<hal::Error> failure;
  loop.run(session.time(), [&](hal::Instant now) {
    session.plugs->advance(now);
    auto devices = hid.devices();
    if (!devices) {
      failure = devices.error();
      return false;
    }
    known.look(session, now, *std::move(devices));
    return true;
  });
  return failure ? complain(*failure) : kExitDone;
}

// Input reports of one device.
int watch_device(const PlugCommand& command, PlugSession& session, hal::Hid& hid) {
  hal::HidMatch match;
  if (!command.board.empty() && command.device.find_first_of(":/") == std::string::npos) {
    const auto board = boards::load_board(command.board);
    if (!board) return complain(board.error());
    const auto wedge = boards::find_wedge(board->bench, command.device);
    if (!wedge) return complain(wedge.error());
    if (wedge->device.path == "sim")
      return complain_usage(fmt::format("{} is emulated: forager reader watch --wedge {} hears it",
                                        command.device, command.device));
    match = boards::wedge_config(*wedge).device;
  } else if (const auto id = usb_id_from(command.device)) {
    match.vendor = id->vendor;
    match.product = id->product;
  } else {
    match.path = command.device;
  }
  const auto device =
      hid.open(match, command.exclusive ? hal::HidSharing::exclusive : hal::HidSharing::shared);
  if (!device) return complain(device.error());
  BenchLoop loop(*session.clock, 5ms);
  std::optional<hal::Error> failure;
  loop.run(session.time(), [&](hal::Instant now) {
    session.plugs->advance(now);
    for (std::array<std::byte, 1024> room;;) {
      const auto count = (*device)->poll(room);
      if (!count) {
        failure = count.error();
        return false;
      }
      if (*count == 0) return true;
      std::string hex;
      for (const std::byte byte : std::span(room).first(*count))
        hex += fmt::format("{:02x}", std::to_integer<unsigned>(byte));
      session.out.record({{"event", "report"}, {"t_s", hal::to_seconds(now)}, {"hex", hex}});
      session.out.line(fmt::format("{:9.3f} s  {} bytes  {}", hal::to_seconds(now), *count, hex));
    }
  });
  return failure ? complain(*failure) : kExitDone;
}

int run(const PlugCommand& command) {
  if (const std::string wrong = mistake_in(command); !wrong.empty()) return complain_usage(wrong);
  PlugSession session(command);
  const auto hid = session.plugs->hid();
  if (!hid) return complain(hid.error());
  if (!command.watch) return list_hid(session, **hid);
  return command.device.empty() ? watch_bus(session, **hid) : watch_device(command, session, **hid);
}

}  // namespace

void add_hid_command(CLI::App& app, int& exit_code) {
  CLI::App* hid = app.add_subcommand("hid", "HID devices: keyboards, readers that type, USB bridges");
  hid->require_subcommand(1);
  auto list = std::make_shared<PlugCommand>();
  CLI::App* sub = hid->add_subcommand("list", "Devices, what they are and which driver has them; opens none");
  add_plug_options(sub, list);
  sub->callback([list, &exit_code] { exit_code = run(*list); });

  auto watch = std::make_shared<PlugCommand>();
  watch->watch = true;
  sub = hid->add_subcommand("watch", "What comes and goes, or with a device named the reports it sends");
  sub->add_option("device", watch->device,
                  "VENDOR:PRODUCT in hex, such as 04d8:00dd, a path, or a name of the board file");
  sub->add_option("--board", watch->board, "Board file with [[wedge]]");
  sub->add_flag("--exclusive", watch->exclusive,
                "What it sends comes here and nowhere else, no console included");
  add_plug_options(sub, watch);
  sub->callback([watch, &exit_code] { exit_code = run(*watch); });
}

}  // namespace forager::tools
