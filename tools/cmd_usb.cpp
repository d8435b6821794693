#include "tools/cmd_usb.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/cli_style.hpp"
#include "tools/plug_session.hpp"

namespace forager::tools {
namespace {

using Json = nlohmann::ordered_json;

std::string drivers_of(const hal::UsbDeviceFacts& device) {
  std::string names;
  for (const auto& interface : device.interfaces) {
    if (interface.driver.empty() || names.find(interface.driver) != std::string::npos) continue;
    names += (names.empty() ? "" : ", ") + interface.driver;
  }
  return names.empty() ? "none" : names;
}

std::string text_of(const hal::UsbDeviceFacts& device) {
  std::string name = device.manufacturer + (device.manufacturer.empty() ? "" : " ") + device.product_name;
  if (name.empty()) name = "(says no name)";
  return fmt::format("{:<8} {:04x}:{:04x}  {}{}  driver {}", device.path, device.vendor, device.product, name,
                     device.serial.empty() ? "" : ", serial " + device.serial, drivers_of(device));
}

Json json_of(const hal::UsbDeviceFacts& device) {
  Json interfaces = Json::array();
  for (const auto& interface : device.interfaces)
    interfaces.push_back({{"number", interface.number},
                          {"class", interface.class_code},
                          {"endpoints", interface.endpoints.size()},
                          {"driver", interface.driver}});
  return {{"path", device.path},
          {"vendor", fmt::format("{:04x}", device.vendor)},
          {"product", fmt::format("{:04x}", device.product)},
          {"manufacturer", device.manufacturer},
          {"name", device.product_name},
          {"serial", device.serial},
          {"interfaces", interfaces}};
}

Json with(Json object, const Json& more) {
  object.update(more);
  return object;
}

int list_usb(PlugSession& session, hal::Usb& usb) {
  const auto devices = usb.devices();
  if (!devices) return complain(devices.error());
  for (const auto& device : *devices) {
    session.out.record(with({{"event", "device"}}, json_of(device)));
    session.out.line(text_of(device));
  }
  if (devices->empty()) fmt::print(stderr, "forager: nothing is plugged in that {} can see\n", usb.name());
  return kExitDone;
}

void show(PlugSession& session, hal::Instant now, const hal::UsbEvent& event) {
  const char* const what = event.arrived ? "plugged in" : "unplugged";
  session.out.record(with({{"event", event.arrived ? "arrived" : "left"},
                           {"t_s", hal::to_seconds(now)},
                           {"permitted", event.permitted}},
                          json_of(event.device)));
  session.out.line(fmt::format("{:9.3f} s  {:<10}  {}", hal::to_seconds(now), what, text_of(event.device)));
  if (event.arrived && !event.permitted)
    session.out.line(
        "             this user may not open it: install boards/99-forager.rules, and plug it in again");
}

int watch_usb(PlugSession& session, hal::Usb& usb) {
  BenchLoop loop(*session.clock);
  std::optional<hal::Error> failure;
  loop.run(session.time(), [&](hal::Instant now) {
    session.plugs->advance(now);
    const auto events = usb.update(now);
    if (!events) {
      failure = events.error();
      return false;
    }
    for (const auto& event : *events) show(session, now, event);
    return true;
  });
  return failure ? complain(*failure) : kExitDone;
}

int run(const PlugCommand& command) {
  if (const std::string wrong = mistake_in(command); !wrong.empty()) return complain_usage(wrong);
  PlugSession session(command);
  const auto usb = session.plugs->usb();
  if (!usb) return complain(usb.error());
  return command.watch ? watch_usb(session, **usb) : list_usb(session, **usb);
}

void add_task(CLI::App& usb, const char* name, const char* what, bool watch, int& exit_code) {
  auto command = std::make_shared<PlugCommand>();
  command->watch = watch;
  CLI::App* sub = usb.add_subcommand(name, what);
  add_plug_options(sub, command);
  sub->callback([command, &exit_code] { exit_code = run(*command); });
}

}  // namespace

void add_usb_command(CLI::App& app, int& exit_code) {
  CLI::App* usb = app.add_subcommand("usb", "What is plugged into USB, what comes and goes; opens nothing");
  usb->require_subcommand(1);
  add_task(*usb, "list", "Devices with their ports, names and the kernel's drivers", false, exit_code);
  add_task(*usb, "watch", "What is plugged in and pulled out, and whether it may be opened", true, exit_code);
}

}  // namespace forager::tools
