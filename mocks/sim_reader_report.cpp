// What the emulated AdvanReader tells about itself: tags, inputs and outputs, state.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <iterator>

#include "mocks/sim_reader.hpp"
#include "mocks/sim_reader_xml.hpp"

namespace forager::mocks {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

std::optional<int> line_of(std::string_view text, int lines) {
  int line = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), line);
  if (error != std::errc() || end != text.data() + text.size() || line < 1 || line > lines)
    return std::nullopt;
  return line;
}

// "20260527 0945.29", as the device writes it.
std::string last_seen(std::int64_t unix_ms) {
  const auto at = std::chrono::sys_seconds(std::chrono::seconds(unix_ms / 1000));
  const auto day = std::chrono::floor<std::chrono::days>(at);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss time(at - day);
  return fmt::format("{:04}{:02}{:02} {:02}{:02}.{:02}", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                     time.hours().count(), time.minutes().count(), time.seconds().count());
}

std::string_view name_of(SimReader::Status status) {
  switch (status) {
    case SimReader::Status::shutdown:
      return "SHUTDOWN";
    case SimReader::Status::stopped:
      return "STOPPED";
    case SimReader::Status::running:
      return "RUNNING";
  }
  return "";
}

}  // namespace

Answer<SimReader::Content> SimReader::do_inventory(const Call& call) { return inventory(call, "inventory"); }
Answer<SimReader::Content> SimReader::do_location(const Call& call) { return inventory(call, "location"); }
Answer<SimReader::Content> SimReader::do_json_location(const Call& call) {
  return inventory(call, "jsonMinLocation");
}

// AUTONOMOUS: the cache of the last timeWindow. SEQUENTIAL: one sweep of all antennas, then the answer.
Answer<SimReader::Content> SimReader::inventory(const Call& call, const char* operation) {
  if (status_ != Status::running)
    return refuse(
        "DEVICE_STOPPED",
        fmt::format("{}() device is stopped. Start it before performing any operation.", operation));
  if (!settings_.sequential()) {
    const auto window = std::chrono::milliseconds(settings_.read_mode_ms("timeWindow"));
    const auto reads = batcher_.recent(call.now, window, settings_.keep_all_reads());
    return Content{inventory_text(operation, reads, call.now),
                   std::string_view(operation) != "jsonMinLocation"};
  }
  if (sweep_) return refuse("OPERATION_NOT_EXECUTED", "A sweep is under way.");
  hal::Duration length{};
  for (const SimAntenna& antenna : settings_.antennas())
    length += std::chrono::milliseconds(
        static_cast<int>(decimal(antenna.read_time).value_or(settings_.read_mode_ms("readTime"))));
  sweep_ = Sweep{operation, call.now + length, {}};
  radiating_ = true;
  field_->radio_on(settings_.radio(), call.now);
  return Content{{}, false, true};
}

std::string SimReader::inventory_text(std::string_view operation, std::span<const SimReadEvent> reads,
                                      hal::Instant now) {
  std::string out;
  if (operation == "jsonMinLocation") {
    out = "<result>";
    events_.append_json(out, reads, *field_);
    return out + "</result>";
  }
  SimReaderEvents::Context context = this->context(now);
  std::vector<std::string> locations;
  if (operation == "location") {
    locations.resize(static_cast<std::size_t>(config_.ports) + 1);
    for (const SimAntenna& antenna : settings_.antennas())
      locations[static_cast<std::size_t>(antenna.port)] =
          fmt::format("{},{},{},{}", antenna.location, antenna.x, antenna.y, antenna.z);
    context.locations = locations;
  }
  events_.append_inventory(out, reads, *field_, context);
  return out;
}

// Output lines are 1-based; vendor samples write True as well as true.
Answer<SimReader::Content> SimReader::do_set_gpo(const Call& call) {
  const auto line = line_of(call.arguments[0], kGpoLines);
  if (!line) return refuse("INVALID_GPO_NUMBER", fmt::format("GPO [{}] does not exist.", call.arguments[0]));
  const std::string value = lower(call.arguments[1]);
  if (value != "true" && value != "false")
    return refuse("PARAMETER_ERROR", fmt::format("[{}] is not true or false.", call.arguments[1]));
  gpo_[static_cast<std::size_t>(*line - 1)] = value == "true";
  note(call.now, fmt::format("GPO {} {}", *line, value == "true" ? "on" : "off"));
  return Content{};
}

Answer<SimReader::Content> SimReader::do_get_gpi(const Call& call) {
  const auto line = line_of(call.arguments[0], kGpiLines);
  if (!line) return refuse("INVALID_GPI_NUMBER", fmt::format("GPI [{}] does not exist.", call.arguments[0]));
  return Content{result_element(gpi_[static_cast<std::size_t>(*line - 1)] ? "true" : "false")};
}

Answer<SimReader::Content> SimReader::do_gpi_all(const Call&) {
  std::string out = "<entries>";
  for (std::size_t index = 0; index < gpi_.size(); ++index)
    fmt::format_to(std::back_inserter(out), "<entry><index>{}</index><result>{}</result></entry>", index,
                   static_cast<bool>(gpi_[index]));
  return Content{out + "</entries>"};
}

Answer<SimReader::Content> SimReader::do_gpio_all(const Call&) {
  std::string out;
  for (std::size_t index = 0; index < gpi_.size(); ++index)
    fmt::format_to(std::back_inserter(out), "<GPI{0}>{1}</GPI{0}>", index + 1,
                   static_cast<bool>(gpi_[index]));
  for (std::size_t index = 0; index < gpo_.size(); ++index)
    fmt::format_to(std::back_inserter(out), "<GPO{0}>{1}</GPO{0}>", index + 1,
                   static_cast<bool>(gpo_[index]));
  return Content{std::move(out)};
}

Answer<SimReader::Content> SimReader::do_save(const Call&) {
  saved_ = settings_;
  return Content{};
}

std::string SimReader::device_xml(hal::Instant now) const {
  std::string serial = config_.product_code + "::" + config_.mac;
  serial.erase(std::remove(serial.begin() + static_cast<std::ptrdiff_t>(config_.product_code.size() + 2),
                           serial.end(), ':'),
               serial.end());
  std::string out = "<device>";
  append_element(out, "id", config_.device_id);
  append_element(out, "ip", config_.ip);
  append_element(out, "mac", config_.mac);
  append_element(out, "serial", serial);
  append_element(out, "family", "AdvanReader");
  append_element(out, "activeDeviceMode", settings_.device_mode());
  append_element(out, "activeReadMode", settings_.read_mode());
  append_element(out, "isAlive", "true");
  append_element(out, "status", name_of(status_));
  append_element(out, "lastSeen", last_seen(reader_ms(now)));
  return out + "</device>";
}

std::string SimReader::status_xml(hal::Instant now) const {
  const std::chrono::hh_mm_ss up(std::chrono::floor<std::chrono::seconds>(now - booted_at_));
  return fmt::format(
      "<id>AdvanNet-instance-{}--1</id><version><class>SW_VERSION</class><version>{}</version>"
      "<revision>{}</revision><date/></version><uptime>{:02}h {:02}m {:02}s</uptime><devices>{}</devices>",
      config_.mac, config_.firmware, config_.firmware_revision, up.hours().count(), up.minutes().count(),
      up.seconds().count(), device_xml(now));
}

}  // namespace forager::mocks
