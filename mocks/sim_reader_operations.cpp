// What the operations of the emulated AdvanReader do (AdvanNet REST catalogue).
#include <fmt/format.h>

#include <array>
#include <iterator>

#include "mocks/sim_reader.hpp"
#include "mocks/sim_reader_operation.hpp"
#include "mocks/sim_reader_xml.hpp"

namespace forager::mocks {
namespace {

using hal::HttpMethod;
using Group = SimReaderValue::Group;

}  // namespace

std::span<const SimReader::Operation> SimReader::operations() {
  constexpr HttpMethod kGet = HttpMethod::get;
  constexpr HttpMethod kPut = HttpMethod::put;
  static constexpr std::array kOperations{
      Operation{"connect", kGet, 0, 0, false, &SimReader::do_connect},
      Operation{"start", kGet, 0, 0, false, &SimReader::do_start},
      Operation{"stop", kGet, 0, 0, false, &SimReader::do_stop},
      Operation{"shutdown", kGet, 0, 0, false, &SimReader::do_shutdown},
      Operation{"deviceModes", kGet, 0, 0, false, &SimReader::do_device_modes},
      Operation{"activeDeviceMode", kGet, 0, 0, false, &SimReader::do_device_mode},
      Operation{"activeDeviceMode", kPut, 0, 0, true, &SimReader::do_device_mode},
      Operation{"activeReadMode", kGet, 0, 0, false, &SimReader::do_read_mode},
      Operation{"activeReadMode", kPut, 0, 0, true, &SimReader::do_read_mode},
      Operation{"readModes", kGet, 0, 0, false, &SimReader::do_read_modes},
      Operation{"readModes", kPut, 0, 0, true, &SimReader::do_read_modes},
      Operation{"reader", kGet, 0, 3, false, &SimReader::do_reader},
      Operation{"reader", kPut, 2, 2, false, &SimReader::do_reader},
      Operation{"parameter", kGet, 1, 2, false, &SimReader::do_parameter},
      Operation{"parameter", kPut, 1, 1, false, &SimReader::do_parameter},
      Operation{"MCU", kGet, 2, 3, false, &SimReader::do_mcu},
      Operation{"MCU", kPut, 2, 2, false, &SimReader::do_mcu},
      Operation{"antennas", kGet, 0, 0, false, &SimReader::do_antennas},
      Operation{"antennas", kPut, 0, 0, true, &SimReader::do_antennas},
      Operation{"inventory", kGet, 0, 0, false, &SimReader::do_inventory},
      Operation{"location", kGet, 0, 0, false, &SimReader::do_location},
      Operation{"jsonMinLocation", kGet, 0, 0, false, &SimReader::do_json_location},
      Operation{"setGPO", kGet, 2, 2, false, &SimReader::do_set_gpo},
      Operation{"getGPI", kGet, 1, 1, false, &SimReader::do_get_gpi},
      Operation{"getGPIAll", kGet, 0, 0, false, &SimReader::do_gpi_all},
      Operation{"gpioAll", kGet, 0, 0, false, &SimReader::do_gpio_all},
      Operation{"confSave", kGet, 0, 0, false, &SimReader::do_save},
  };
  return kOperations;
}

Answer<SimReader::Content> SimReader::do_connect(const Call&) {
  if (status_ == Status::shutdown) status_ = Status::stopped;
  return Content{};
}

// Starting what runs is harmless: vendor samples do it every ten minutes.
Answer<SimReader::Content> SimReader::do_start(const Call& call) {
  if (status_ == Status::shutdown)
    return refuse("DEVICE_NOT_CONNECTED", "start() device is shut down. Connect it first.");
  if (status_ == Status::stopped && !settings_.sequential()) start_radio(call.now);
  status_ = Status::running;
  return Content{};
}

Answer<SimReader::Content> SimReader::do_stop(const Call& call) {
  stop_radio(call.now);
  sweep_.reset();
  if (status_ == Status::running) status_ = Status::stopped;
  return Content{};
}

Answer<SimReader::Content> SimReader::do_shutdown(const Call& call) {
  stop_radio(call.now);
  sweep_.reset();
  status_ = Status::shutdown;
  return Content{};
}

// Only what this emulator can do is listed; a real unit has "Alarm mode" too.
Answer<SimReader::Content> SimReader::do_device_modes(const Call&) {
  std::string out = "<entries>";
  for (const auto& [id, mode] :
       {std::pair{"Autonomous", "AUTONOMOUS"}, std::pair{"Sequential", "SEQUENTIAL"}})
    fmt::format_to(std::back_inserter(out),
                   "<entry><class>DEVICE_MODE</class><id>{0}</id><defaultReadMode>{1}</defaultReadMode>"
                   "<readModes><readMode><name>{1}</name></readMode></readModes></entry>",
                   id, mode);
  return Content{out + "</entries>"};
}

Answer<SimReader::Content> SimReader::do_device_mode(const Call& call) {
  if (call.method == HttpMethod::get) return Content{result_element(settings_.device_mode())};
  return settings_.set_device_mode(call.body).map([] { return Content{}; });
}

Answer<SimReader::Content> SimReader::do_read_mode(const Call& call) {
  if (call.method == HttpMethod::get) return Content{result_element(settings_.read_mode())};
  return settings_.set_read_mode(call.body).map([] { return Content{}; });
}

Answer<SimReader::Content> SimReader::do_read_modes(const Call& call) {
  if (call.method == HttpMethod::put)
    return settings_.set_read_mode_parameters(call.body).map([] { return Content{}; });
  std::string out = "<entries><entry>";
  settings_.append_read_mode(out);
  return Content{out + "</entry></entries>"};
}

// /reader, /reader/params, /reader/parameter/NAME and /reader/parameter/NAME/value (a write by GET).
Answer<SimReader::Content> SimReader::do_reader(const Call& call) {
  const auto arguments = call.arguments;
  if (arguments.size() >= 2 && arguments[0] == "parameter")
    return access_parameter({call.method, arguments.subspan(2), call.body, call.now}, Group::reader,
                            arguments[1]);
  if (arguments.size() > 1 || (arguments.size() == 1 && arguments[0] != "params"))
    return refuse("UNKNOWN_OPERATION", fmt::format("Operation [{}] unknown.", arguments.back()));
  std::string out = "<params>";
  for (const SimReaderValue& known : sim_reader_parameters()) {
    if (known.group != Group::reader) continue;
    fmt::format_to(std::back_inserter(out), "<{0}><result>{1}</result><read-only>{2}</read-only></{0}>",
                   known.name, settings_.parameter(known.name).value_or(""), known.read_only);
  }
  return Content{out + "</params><ip>/dev/ttyO1</ip><model>M6e</model>"};
}

Answer<SimReader::Content> SimReader::do_parameter(const Call& call) {
  return access_parameter({call.method, call.arguments.subspan(1), call.body, call.now}, Group::device,
                          call.arguments[0]);
}

Answer<SimReader::Content> SimReader::do_mcu(const Call& call) {
  if (call.arguments[0] != "parameter")
    return refuse("UNKNOWN_OPERATION", fmt::format("Operation [{}] unknown.", call.arguments[0]));
  return access_parameter({call.method, call.arguments.subspan(2), call.body, call.now}, Group::mcu,
                          call.arguments[1]);
}

Answer<SimReader::Content> SimReader::access_parameter(const Call& call, Group group, std::string_view name) {
  const SimReaderValue* known = find_value(sim_reader_parameters(), name);
  if (known == nullptr || known->group != group)
    return refuse("PARAMETER_ERROR", fmt::format("Parameter [{}] unknown.", name));
  if (call.method == HttpMethod::get && call.arguments.empty())
    return settings_.parameter(name).map(
        [](const std::string& value) { return Content{result_element(value)}; });
  const auto answer =
      settings_.set_parameter(name, call.method == HttpMethod::put ? call.body : call.arguments[0]);
  if (!answer) return tl::unexpected(answer.error());
  if (group == Group::reader) renew_radio(call.now);
  return Content{};
}

Answer<SimReader::Content> SimReader::do_antennas(const Call& call) {
  if (call.method == HttpMethod::put) return settings_.set_antennas(call.body).map([] { return Content{}; });
  std::string out;
  settings_.append_antennas(out);
  return Content{std::move(out)};
}

}  // namespace forager::mocks
