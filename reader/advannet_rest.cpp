#include "reader/advannet_rest.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "reader/advannet_wire.hpp"
#include "reader/advannet_xml.hpp"

namespace forager::reader::advannet {
namespace {

constexpr std::string_view kXml = "text/xml";

hal::HttpRequest get(std::string path) {
  hal::HttpRequest request;
  request.path = std::move(path);
  return request;
}

// The vendor's client sends every body as text/xml, plain values too; the reader does not look.
hal::HttpRequest put(std::string path, std::string body) {
  hal::HttpRequest request;
  request.method = hal::HttpMethod::put;
  request.path = std::move(path);
  request.body = std::move(body);
  request.content_type = std::string(kXml);
  return request;
}

std::string device_path(std::string_view id, std::string_view rest) {
  return fmt::format("/devices/{}{}{}", percent_encode(id), rest.empty() ? "" : "/", rest);
}

std::string own_value(std::string_view name, const std::optional<double>& dbm) {
  return dbm ? fmt::format("<{0}>{1}</{0}>", name, *dbm) : fmt::format("<{}/>", name);
}

std::optional<double> as_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::string percent_encode(std::string_view segment) {
  std::string out;
  for (const char c : segment) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '.' || c == '_' || c == '~';
    if (plain)
      out += c;
    else
      out += fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
  }
  return out;
}

hal::HttpRequest get_devices() { return get("/devices"); }
hal::HttpRequest get_status() { return get("/status"); }
hal::HttpRequest get_device(std::string_view id) { return get(device_path(id, "")); }

hal::HttpRequest get_operation(std::string_view id, std::string_view operation) {
  return get(device_path(id, operation));
}

hal::HttpRequest set_gpo(std::string_view id, unsigned line, bool active) {
  return get(device_path(id, fmt::format("setGPO/{}/{}", line, active)));
}

hal::HttpRequest put_device_mode(std::string_view id, std::string_view mode) {
  return put(device_path(id, "activeDeviceMode"), std::string(mode));
}

hal::HttpRequest put_read_mode(std::string_view id, const ReadPlan& plan) {
  using std::chrono::milliseconds;
  return put(
      device_path(id, percent_encode("readModes[0]")),
      fmt::format("<request><class>READMODE_AUTONOMOUS</class><name>{}</name>"
                  "<useFastSearch>false</useFastSearch><swFilterOnly>false</swFilterOnly>"
                  "<filterMaskOffset>32</filterMaskOffset><filterMaskBitLength>0</filterMaskBitLength>"
                  "<filterMaskHex/><calibratorsRefreshPeriod>60</calibratorsRefreshPeriod>"
                  "<keepAllReads>false</keepAllReads><asynch>true</asynch>"
                  "<cleanBufferOnSynchRead>false</cleanBufferOnSynchRead>"
                  "<timeWindow>2500</timeWindow><onTime>{}</onTime><offTime>{}</offTime></request>",
                  kReadModeAutonomous, plan.on_time / milliseconds(1), plan.off_time / milliseconds(1)));
}

hal::HttpRequest put_antennas(std::string_view id, const ReadPlan& plan) {
  std::string body = "<request><entries>";
  for (const ReadPort& port : plan.ports) {
    const std::string name = port.name.empty() ? fmt::format("port{}", port.port) : port.name;
    // device, port, two multiplexers (none), orientation (none), location and its coordinates
    body += fmt::format(
        "<entry><class>ANTENNA_DEFINITION</class><def>{},{},0,0,-1,{},0,0,0</def>"
        "<conf><class>ANTENNA_CONF</class>{}{}<readTime/></conf></entry>",
        escape_text(id), port.port, escape_text(name), own_value("power", port.power_dbm),
        own_value("sensitivity", port.sensitivity_dbm));
  }
  body += "</entries></request>";
  return put(device_path(id, "antennas"), std::move(body));
}

hal::HttpRequest put_parameter(std::string_view id, std::string_view name, std::string_view value) {
  return put(device_path(id, fmt::format("reader/parameter/{}", percent_encode(name))), std::string(value));
}

hal::HttpRequest get_parameter(std::string_view id, std::string_view name) {
  return get(device_path(id, fmt::format("reader/parameter/{}", percent_encode(name))));
}

std::string describe_request(const hal::HttpRequest& request) {
  std::string_view what = request.path;
  if (what.starts_with("/devices/")) {
    const std::size_t slash = what.find('/', std::string_view("/devices/").size());
    if (slash != std::string_view::npos) what.remove_prefix(slash + 1);
  }
  constexpr std::string_view kParameter = "reader/parameter/";
  if (what.starts_with(kParameter)) what.remove_prefix(kParameter.size());
  std::string line = fmt::format("{} {}", request.method == hal::HttpMethod::put ? "PUT" : "GET", what);
  if (!request.body.empty() && request.body.front() != '<') line += fmt::format(" = {}", request.body);
  return line;
}

std::vector<Setting> settings_of(const ReadPlan& plan) {
  return {{kReadPower, fmt::format("{}", plan.power_dbm), "power_dbm", true},
          {kSensitivity, fmt::format("{}", plan.sensitivity_dbm), "sensitivity_dbm", false},
          {kSession, std::string(to_string(plan.session)), "session", true},
          {kTarget, std::string(to_string(plan.target)), "target", true},
          {kQ, plan.q ? fmt::format("Q_{}", *plan.q) : std::string("Q_DYNAMIC"), "q", false}};
}

bool same_value(std::string_view wanted, std::string_view answered) {
  if (wanted == answered) return true;
  const auto a = as_number(wanted);
  const auto b = as_number(answered);
  return a && b && std::abs(*a - *b) < 0.05;
}

}  // namespace forager::reader::advannet
