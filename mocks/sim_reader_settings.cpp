#include "mocks/sim_reader_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "mocks/sim_reader_values.hpp"
#include "mocks/sim_reader_xml.hpp"

namespace forager::mocks {
namespace {

std::map<std::string, std::string, std::less<>> initial_values(std::span<const SimReaderValue> table) {
  std::map<std::string, std::string, std::less<>> values;
  for (const SimReaderValue& value : table) values.emplace(value.name, value.initial);
  return values;
}

Answer<int> integer_field(std::string_view text, int low, int high, std::string_view what) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size() && number >= low && number <= high)
    return number;
  return refuse("PARAMETER_ERROR", fmt::format("antenna {} [{}] is not in {}..{}.", what, text, low, high));
}

std::string text_of(std::string_view xml, std::string_view name) {
  return xml_unescaped(trimmed(find_element(xml, name).value_or(std::string_view{})));
}

// "device,port,mux1,mux2,orientation,location,x,y,z"
using DefFields = std::array<std::string, 9>;
std::optional<DefFields> split_def(std::string_view def) {
  DefFields fields;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const std::size_t comma = def.find(',');
    if ((comma == std::string_view::npos) != (k + 1 == fields.size())) return std::nullopt;
    fields[k] = std::string(trimmed(def.substr(0, comma)));
    if (comma != std::string_view::npos) def.remove_prefix(comma + 1);
  }
  return fields;
}

DefFields fields_of(std::string_view entry, const std::string& device_id) {
  if (const auto def = find_element(entry, "def"))
    return split_def(xml_unescaped(trimmed(*def))).value_or(DefFields{});
  const auto or_zero = [entry](std::string_view name) {
    const std::string text = text_of(entry, name);
    return text.empty() ? std::string("0") : text;
  };
  return {device_id,       text_of(entry, "port"), or_zero("mux1"),
          or_zero("mux2"), or_zero("orientation"), text_of(entry, "locID"),
          or_zero("x"),    or_zero("y"),           or_zero("z")};
}

Answer<> check_conf(std::string_view name, const std::string& text) {
  const std::string_view limits = name == "power"         ? "RF_READ_POWER"
                                  : name == "sensitivity" ? "RF_SENSITIVITY"
                                                          : "readTime";
  const auto table = name == "readTime" ? sim_sequential_parameters() : sim_reader_parameters();
  if (text.empty() || allows(*find_value(table, limits), text)) return {};
  return refuse("PARAMETER_ERROR", fmt::format("antenna {} [{}] is not allowed.", name, text));
}

}  // namespace

SimReaderSettings::SimReaderSettings(std::string device_id, int ports, bool autostart)
    : device_id_(std::move(device_id)),
      ports_(ports),
      parameters_(initial_values(sim_reader_parameters())),
      autonomous_(initial_values(sim_autonomous_parameters())),
      sequential_values_(initial_values(sim_sequential_parameters())) {
  parameters_["RF_PORT_NUMBER"] = std::to_string(ports);
  parameters_["DEVICE_RUNTIME_AUTOSTART"] = autostart ? "true" : "false";
  SimAntenna first;
  first.location = "shelf1";
  first.power = "30";
  first.sensitivity = "-70";
  antennas_.push_back(std::move(first));
}

Answer<> SimReaderSettings::set_parameter(std::string_view name, std::string_view value) {
  const SimReaderValue* known = find_value(sim_reader_parameters(), name);
  if (known == nullptr) return refuse("PARAMETER_ERROR", fmt::format("Parameter [{}] unknown.", name));
  if (known->read_only)
    return refuse("OPERATION_NOT_EXECUTED", fmt::format("Parameter [{}] is read only.", name));
  const std::string_view text = trimmed(value);
  if (!allows(*known, text))
    return refuse("PARAMETER_ERROR", fmt::format("Value [{}] not allowed for parameter [{}].", text, name));
  parameters_.find(name)->second = std::string(text);
  if (name == "RF_ASYNCH_ONTIME") autonomous_.find("onTime")->second = std::string(text);
  if (name == "RF_ASYNCH_OFFTIME") autonomous_.find("offTime")->second = std::string(text);
  return {};
}

Answer<std::string> SimReaderSettings::parameter(std::string_view name) const {
  const auto found = parameters_.find(name);
  if (found != parameters_.end()) return found->second;
  return refuse("PARAMETER_ERROR", fmt::format("Parameter [{}] unknown.", name));
}

bool SimReaderSettings::is_read_only(std::string_view name) {
  const SimReaderValue* known = find_value(sim_reader_parameters(), name);
  return known != nullptr && known->read_only;
}

std::vector<std::string_view> SimReaderSettings::reader_parameter_names() {
  std::vector<std::string_view> names;
  for (const SimReaderValue& value : sim_reader_parameters())
    if (value.group == SimReaderValue::Group::reader) names.push_back(value.name);
  return names;
}

Answer<> SimReaderSettings::set_device_mode(std::string_view id) {
  const std::string_view text = trimmed(id);
  if (text != "Autonomous" && text != "Sequential")
    return refuse("DEVICEMODE_DO_NOT_EXIST", fmt::format("Device mode [{}] does not exist.", text));
  sequential_ = text == "Sequential";
  return {};
}

Answer<> SimReaderSettings::set_read_mode(std::string_view name) {
  const std::string_view text = trimmed(name);
  if (text == read_mode()) return {};
  return refuse("INVALID_READMODE",
                fmt::format("Read mode [{}] is not available in device mode [{}].", text, device_mode()));
}

Answer<> SimReaderSettings::set_read_mode_parameters(std::string_view xml) {
  const auto request = find_element(xml, "request");
  if (!request) return refuse("INVALID_REQUEST", "No request element.");
  const auto table = sequential_ ? sim_sequential_parameters() : sim_autonomous_parameters();
  Values values = sequential_ ? sequential_values_ : autonomous_;
  std::string_view rest = *request;
  while (const auto element = next_element(rest)) {
    const std::string text = xml_unescaped(trimmed(element->inner));
    if (element->name == "name" || element->name == "class") {
      const std::string_view mode = text.starts_with("READMODE_") ? std::string_view(text).substr(9) : text;
      if (mode != read_mode()) return refuse("INVALID_READMODE", fmt::format("[{}] is not active.", text));
      continue;
    }
    const SimReaderValue* known = find_value(table, element->name);
    if (known == nullptr)
      return refuse("PARAMETER_ERROR", fmt::format("Read mode parameter [{}] unknown.", element->name));
    if (!allows(*known, text))
      return refuse("PARAMETER_ERROR", fmt::format("Value [{}] not allowed for [{}].", text, element->name));
    values.find(element->name)->second = text;
  }
  (sequential_ ? sequential_values_ : autonomous_) = std::move(values);
  // One pair of times in the radio module, reached under two names.
  parameters_.find("RF_ASYNCH_ONTIME")->second = autonomous_.find("onTime")->second;
  parameters_.find("RF_ASYNCH_OFFTIME")->second = autonomous_.find("offTime")->second;
  return {};
}

void SimReaderSettings::append_read_mode(std::string& out) const {
  append_element(out, "class", fmt::format("READMODE_{}", read_mode()));
  append_element(out, "name", read_mode());
  for (const SimReaderValue& value : sequential_ ? sim_sequential_parameters() : sim_autonomous_parameters())
    append_element(out, value.name,
                   (sequential_ ? sequential_values_ : autonomous_).find(value.name)->second);
}

int SimReaderSettings::read_mode_ms(std::string_view parameter) const {
  const Values& values = sequential_ ? sequential_values_ : autonomous_;
  const auto found = values.find(parameter);
  return found == values.end() ? 0 : static_cast<int>(decimal(found->second).value_or(0.0));
}

bool SimReaderSettings::keep_all_reads() const { return autonomous_.find("keepAllReads")->second == "true"; }

Answer<SimAntenna> SimReaderSettings::antenna_from(std::string_view entry) const {
  const DefFields fields = fields_of(entry, device_id_);
  if (fields[0] != device_id_)
    return refuse("PARAMETER_ERROR",
                  fmt::format("Antenna definition of device [{}] not understood.", fields[0]));
  SimAntenna antenna;
  const auto port = integer_field(fields[1], 1, ports_, "port");
  if (!port) return tl::unexpected(port.error());
  antenna.port = *port;
  for (const std::size_t mux : {std::size_t{2}, std::size_t{3}})
    if (const auto number = integer_field(fields[mux], 0, 0, "mux (none is connected)"); !number)
      return tl::unexpected(number.error());
  const auto orientation = integer_field(fields[4], -1, 1, "orientation");
  if (!orientation) return tl::unexpected(orientation.error());
  antenna.orientation = *orientation;
  antenna.location = fields[5];
  antenna.x = fields[6];
  antenna.y = fields[7];
  antenna.z = fields[8];
  const std::string_view conf = find_element(entry, "conf").value_or(std::string_view{});
  antenna.power = text_of(conf, "power");
  antenna.sensitivity = text_of(conf, "sensitivity");
  antenna.read_time = text_of(conf, "readTime");
  for (const auto& [name, text] : {std::pair<std::string_view, const std::string&>{"power", antenna.power},
                                   {"sensitivity", antenna.sensitivity},
                                   {"readTime", antenna.read_time}})
    if (const auto answer = check_conf(name, text); !answer) return tl::unexpected(answer.error());
  return antenna;
}

Answer<> SimReaderSettings::set_antennas(std::string_view xml) {
  const auto entries = find_element(xml, "entries");
  if (!entries) return refuse("INVALID_REQUEST", "No entries element.");
  std::vector<SimAntenna> antennas;
  std::string_view rest = *entries;
  while (const auto entry = next_element(rest)) {
    auto antenna = antenna_from(entry->inner);
    if (!antenna) return tl::unexpected(antenna.error());
    if (std::ranges::find(antennas, antenna->port, &SimAntenna::port) != antennas.end())
      return refuse("PARAMETER_ERROR", fmt::format("Port [{}] defined twice.", antenna->port));
    antennas.push_back(std::move(*antenna));
  }
  antennas_ = std::move(antennas);
  return {};
}

void SimReaderSettings::append_antennas(std::string& out) const {
  out += "<entries>";
  for (const SimAntenna& antenna : antennas_) {
    out += "<entry><class>ANTENNA_DEFINITION</class>";
    append_element(out, "def",
                   fmt::format("{},{},0,0,{},{},{},{},{}", device_id_, antenna.port, antenna.orientation,
                               antenna.location, antenna.x, antenna.y, antenna.z));
    out += "<conf><class>ANTENNA_CONF</class>";
    for (const auto& [name, text] : {std::pair<std::string_view, const std::string&>{"power", antenna.power},
                                     {"sensitivity", antenna.sensitivity},
                                     {"readTime", antenna.read_time}}) {
      if (text.empty())
        fmt::format_to(std::back_inserter(out), "<{}/>", name);
      else
        append_element(out, name, text);
    }
    out += "</conf></entry>";
  }
  out += "</entries>";
}

RadioSettings SimReaderSettings::radio() const {
  RadioSettings radio;
  const auto value = [this](std::string_view name) -> const std::string& {
    return parameters_.find(name)->second;
  };
  const std::string& target = value("GEN2_TARGET");
  const std::string& q = value("GEN2_Q");
  radio.session = value("GEN2_SESSION").back() - '0';
  radio.target = target.size() == 1 ? target.front() : '*';
  radio.q = q == "Q_DYNAMIC" ? -1 : static_cast<int>(decimal(q.substr(2)).value_or(-1.0));
  radio.on_time = std::chrono::milliseconds(read_mode_ms(sequential_ ? "readTime" : "onTime"));
  radio.off_time = std::chrono::milliseconds(sequential_ ? 0 : read_mode_ms("offTime"));
  for (const SimAntenna& antenna : antennas_)
    radio.ports.push_back(
        {antenna.port, decimal(antenna.power).value_or(decimal(value("RF_READ_POWER")).value_or(0.0)),
         decimal(antenna.sensitivity).value_or(decimal(value("RF_SENSITIVITY")).value_or(0.0))});
  return radio;
}

}  // namespace forager::mocks
