#include "reader/advannet_events.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

#include "reader/advannet_xml.hpp"

namespace forager::reader {
namespace {

using advannet::XmlScanner;
using Token = XmlScanner::Token;

constexpr std::size_t kMaxText = 256;
constexpr std::size_t kMaxValues = 64;                     // of one list; a reader has 32 ports
constexpr std::int64_t kMaxStampMs = 100'000'000'000'000;  // year 5138; keeps sums inside 64 bits

template <class T>
std::optional<T> number(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<std::int64_t> stamp(std::string_view text) {
  const auto value = number<std::int64_t>(text);
  return value && *value > 0 && *value <= kMaxStampMs ? value : std::nullopt;
}

// A finite number: whole in every capture, which is quick to read; a fraction would do no harm.
std::optional<double> measurement(std::string_view text) {
  if (const auto whole = number<std::int32_t>(text)) return *whole;
  const auto value = number<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

// A property value: one text or several, separated by commas.
struct Values {
  std::string_view all;
  std::size_t count = 0;

  void set_once(std::string_view text) {
    if (count != 0) return;
    all = text;
    count = 1 + static_cast<std::size_t>(std::ranges::count(text, ','));
  }
  // The value for read i of n.
  [[nodiscard]] std::string_view at(std::size_t i, std::size_t n) const {
    std::string_view rest = all;
    for (std::size_t skip = count == n ? i : 0; skip > 0; --skip) rest.remove_prefix(rest.find(',') + 1);
    rest = rest.substr(0, rest.find(','));
    while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
    while (!rest.empty() && rest.back() == ' ') rest.remove_suffix(1);
    return rest;
  }
};

struct Item {
  std::string_view epc;
  std::string_view hex_epc;
  std::string_view time;
  Values stamp, rssi, phase, port, frequency, count;

  void property(std::string_view text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) return;
    const std::string_view name = text.substr(0, colon);
    const std::string_view value = text.substr(colon + 1);
    if (name == "RSSI")
      rssi.set_once(value);
    else if (name == "ANTENNA_PORT")
      port.set_once(value);
    else if (name == "TIME_STAMP")
      stamp.set_once(value);
    else if (name == "RF_PHASE")
      phase.set_once(value);
    else if (name == "FREQ")
      frequency.set_once(value);
    else if (name == "READ_COUNT")
      count.set_once(value);
  }
};

std::int16_t rssi_of(std::string_view text) {
  const auto dbm = measurement(text);
  if (!dbm || !(std::abs(*dbm) < 1000.0)) return TagRead::kNoRssi;
  return static_cast<std::int16_t>(std::lround(*dbm));
}

TagRead make_read(const Epc& epc, const Item& item, std::size_t i, std::size_t n) {
  TagRead read;
  read.epc = epc;
  read.port = number<std::uint8_t>(item.port.at(i, n)).value_or(0);
  read.rssi_dbm = rssi_of(item.rssi.at(i, n));
  read.phase_deg = measurement(item.phase.at(i, n));
  read.frequency_khz = number<std::uint32_t>(item.frequency.at(i, n)).value_or(0);
  read.read_count = std::max(1U, number<std::uint32_t>(item.count.at(i, n)).value_or(1));
  return read;
}

void add_reads(const Item& item, std::optional<std::int64_t> message_ms, AdvanNetMessage& out) {
  const auto epc = Epc::from_hex(item.epc.empty() ? item.hex_epc : item.epc);
  const std::size_t n = item.port.count <= kMaxValues ? std::max<std::size_t>(1, item.port.count) : 1;
  std::optional<std::int64_t> item_ms = stamp(item.time);
  if (!item_ms) item_ms = stamp(item.stamp.at(0, n));
  if (!item_ms) item_ms = message_ms;
  if (!epc || !item_ms) {
    ++out.bad_items;
    return;
  }
  for (std::size_t i = 0; i < n; ++i) {
    TagRead read = make_read(*epc, item, i, n);
    const auto own_ms = n > 1 && item.stamp.count == n ? stamp(item.stamp.at(i, n)) : std::nullopt;
    read.reader_ms = own_ms.value_or(*item_ms);
    out.reads.push_back(read);
  }
}

// Inside <item>: everything up to its close.
void read_item(XmlScanner& xml, std::optional<std::int64_t> message_ms, AdvanNetMessage& out) {
  Item item;
  const std::size_t outside = xml.depth() - 1;
  while (true) {
    const Token token = xml.next();
    if (token == Token::error || token == Token::end) return;
    if (token == Token::close && xml.depth() == outside) break;
    if (token != Token::open) continue;
    const std::string_view name = xml.name();
    if (name == "prop")
      item.property(xml.leaf_text());
    else if (name == "epc" && item.epc.empty())
      item.epc = xml.leaf_text();
    else if (name == "hexepc" && item.hex_epc.empty())
      item.hex_epc = xml.leaf_text();
    else if (name == "ts" && item.time.empty())
      item.time = xml.leaf_text();
    else
      (void)xml.skip_leaf();  // false: it has children, the walk goes into them
  }
  add_reads(item, message_ms, out);
}

void read_inventory(XmlScanner& xml, AdvanNetMessage& out) {
  std::optional<std::int64_t> message_ms;
  while (true) {
    const Token token = xml.next();
    if (token == Token::error || token == Token::end) return;
    if (token != Token::open) continue;
    if (xml.name() == "item")
      read_item(xml, message_ms, out);
    else if (xml.name() == "ts" && !message_ms)
      message_ms = stamp(xml.leaf_text());
  }
}

// Both event messages: <event> with <type>, and what belongs to the type.
void read_events(XmlScanner& xml, AdvanNetMessage& out) {
  std::string_view line;
  std::string_view level;
  std::string_view time;
  while (true) {
    const Token token = xml.next();
    if (token == Token::error || token == Token::end) return;
    if (token == Token::close && xml.name() == "event") {
      const auto number_of_line = number<std::uint8_t>(line);
      if (number_of_line && (level == "true" || level == "false"))
        out.inputs.push_back({*number_of_line, level == "true", stamp(time).value_or(0)});
      else if (out.type == "GPI")
        ++out.bad_items;
      line = level = time = {};
    }
    if (token != Token::open) continue;
    const std::string_view name = xml.name();
    if (name == "line")
      line = xml.leaf_text();
    else if (name == "lowToHigh")
      level = xml.leaf_text();
    else if (name == "ts" && time.empty())
      time = xml.leaf_text();
    else if (name == "type" && out.type.empty())
      advannet::decode_text(xml.leaf_text(), kMaxText, out.type);
    else if (name == "msg" && out.text.empty())
      advannet::decode_text(xml.leaf_text(), kMaxText, out.text);
  }
}

}  // namespace

void AdvanNetMessage::clear() {
  kind = Kind::unknown;
  reads.clear();
  inputs.clear();
  bad_items = 0;
  type.clear();
  text.clear();
}

hal::Result<> decode_advannet_message(std::string_view body, AdvanNetMessage& out) {
  out.clear();
  if (body.starts_with('{') || body.starts_with('['))
    return hal::fail(hal::ErrorCode::unsupported, "event stream", "decode message", "is JSON, not XML",
                     "Set the reader's COMM_TCP3177_ENCODER to XML_V2_3");
  XmlScanner xml(body);
  if (xml.next() == Token::open) {
    if (xml.name() == "inventory") {
      out.kind = AdvanNetMessage::Kind::inventory;
      read_inventory(xml, out);
    } else if (xml.name() == "deviceEventMessage" || xml.name() == "eventMessage") {
      out.kind = xml.name() == "eventMessage" ? AdvanNetMessage::Kind::server_event
                                              : AdvanNetMessage::Kind::device_event;
      read_events(xml, out);
    }
  }
  Token token = Token::open;
  while (token != Token::end && token != Token::error) token = xml.next();
  if (token == Token::end) return {};
  out.clear();
  return hal::fail(hal::ErrorCode::protocol, "event stream", "decode message", std::string(xml.problem()));
}

}  // namespace forager::reader
