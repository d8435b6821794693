#include "mocks/sim_reader_events.hpp"

#include <fmt/format.h>

#include <iterator>

#include "mocks/sim_reader_xml.hpp"

namespace forager::mocks {
namespace {

// "<prop>NAME:value</prop>", or "value,second" as the reader writes folded reads.
void append_prop(std::string& out, std::string_view opening, std::int64_t value, bool comma,
                 std::int64_t second) {
  out += opening;
  append_number(out, value);
  if (comma) {
    out += ',';
    append_number(out, second);
  }
  out += "</prop>";
}

}  // namespace

SimReaderEvents::SimReaderEvents(const SimReaderConfig& config)
    : device_id_(config.device_id), instance_("AdvanNet-instance-" + config.mac + "--1") {
  const std::string device = "<deviceId>" + device_id_ + "</deviceId>";
  preamble_ = "</ts><status>OK</status><msg-version>2.3.0</msg-version><op>inventory</op><data><advanNetId>" +
              instance_ + "</advanNetId>" + device + "<inventory><class>INVENTORY</class>" + device +
              "<size>";
  after_ts_ = "</ts>" + device + "<data><class>TAG_DATA</class><hexepc>";
}

void SimReaderEvents::append_inventory(std::string& out, std::span<const SimReadEvent> reads, TagField& field,
                                       const Context& context) {
  gpi_prop_ = "<prop>GPI:{";
  for (const bool level : context.gpi) {
    if (gpi_prop_.back() != '{') gpi_prop_ += ':';
    gpi_prop_ += level ? '1' : '0';
  }
  gpi_prop_ += "}</prop>";
  out += "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<inventory><type>inventory</type><ts>";
  append_number(out, context.now_ms);
  out += preamble_;
  append_number(out, reads.size());
  out += "</size><items>";
  for (const SimReadEvent& event : reads) {
    const std::string* epc = &field.epc_hex(event.read.tag);
    if (context.upper_case_epc) {
      epc_ = *epc;
      for (char& digit : epc_)
        if (digit >= 'a' && digit <= 'f') digit = static_cast<char>(digit - 'a' + 'A');
      epc = &epc_;
    }
    append_item(out, event, *epc, context);
  }
  out += "</items></inventory></data></inventory>";
}

void SimReaderEvents::append_item(std::string& out, const SimReadEvent& event, std::string_view epc,
                                  const Context& context) {
  const AirRead& read = event.read;
  const bool comma = event.comma_props;
  out += "<item><class>READ_EVENT</class><epc>";
  out += epc;
  out += "</epc><decoded></decoded><ts>";
  append_number(out, event.reader_ms);
  out += after_ts_;
  out += epc;
  out += "</hexepc><tid></tid><data></data><props>";
  append_prop(out, "<prop>TIME_STAMP:", event.reader_ms, comma, event.reader_ms + 7);
  append_prop(out, "<prop>RSSI:", read.rssi_dbm, comma, read.rssi_dbm - 3);
  append_prop(out, "<prop>RF_PHASE:", read.phase_deg, comma, (read.phase_deg + 60) % 180);
  append_prop(out, "<prop>ANTENNA_PORT:", read.port, comma, read.port);
  append_prop(out, "<prop>MUX1:", 0, comma, 0);
  append_prop(out, "<prop>MUX2:", 0, comma, 0);
  append_prop(out, "<prop>FREQ:", read.frequency_khz, comma, read.frequency_khz);
  out += gpi_prop_;
  append_prop(out, "<prop>READ_COUNT:", event.read_count, comma, 1);
  out += "</props></data><location><class>LOCATION_DEFINITION</class><loc></loc><ts></ts></location>";
  const auto port = static_cast<std::size_t>(read.port);
  if (port < context.locations.size()) {
    out += "<locationData><epc>";
    out += epc;
    out += "</epc><location>";
    append_element(out, "loc", context.locations[port]);
    out += "</location></locationData>";
  }
  out += "</item>";
}

void SimReaderEvents::append_json(std::string& out, std::span<const SimReadEvent> reads, TagField& field) {
  std::string_view separator = "[";
  for (const SimReadEvent& event : reads) {
    fmt::format_to(std::back_inserter(out),
                   R"({}{{"epc":"{}","ts":{},"port":{},"mux1":0,"mux2":0,"rssi":{},"phase":{},"rc":{}}})",
                   separator, field.epc_hex(event.read.tag), event.reader_ms, event.read.port,
                   event.read.rssi_dbm, event.read.phase_deg, event.read_count);
    separator = ",";
  }
  out += reads.empty() ? "[]" : "]";
}

void SimReaderEvents::append_gpi(std::string& out, int line, bool low_to_high, std::int64_t now_ms) const {
  fmt::format_to(std::back_inserter(out),
                 "<deviceEventMessage><deviceId>{0}</deviceId><event><class>GPI_EVENT</class><type>GPI</type>"
                 "<ts>{1}</ts><deviceId>{0}</deviceId><line>{2}</line><lowToHigh>{3}</lowToHigh></event>"
                 "</deviceEventMessage>",
                 device_id_, now_ms, line, low_to_high);
}

}  // namespace forager::mocks
