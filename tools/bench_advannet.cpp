#include <fmt/format.h>

#include <charconv>
#include <memory>
#include <pugixml.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "reader/advannet_events.hpp"
#include "tools/bench_duel.hpp"

namespace forager::tools {
namespace {

constexpr int kItems = 20;  // a full message of a busy reader

std::string message() {
  std::string items;
  for (int i = 0; i < kItems; ++i)
    items += fmt::format(
        "<item><class>READ_EVENT</class><epc>3034257bf7194e40{0:08x}</epc><decoded></decoded><ts>{1}</ts>"
        "<deviceId>AdvanReader-m4-160</deviceId><data><class>TAG_DATA</class>"
        "<hexepc>3034257bf7194e40{0:08x}</hexepc><tid></tid><data></data><props><prop>TIME_STAMP:{1}</prop>"
        "<prop>RSSI:-{2}</prop><prop>RF_PHASE:45</prop><prop>ANTENNA_PORT:{3}</prop><prop>MUX1:0</prop>"
        "<prop>MUX2:0</prop><prop>FREQ:866300</prop><prop>GPI:{{0:0:0:0}}</prop><prop>READ_COUNT:1</prop>"
        "</props></data><location><class>LOCATION_DEFINITION</class><loc></loc><ts></ts></location></item>",
        i, 1779868346683 + i, 40 + i, 1 + i % 4);
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<inventory><type>inventory</type><ts>1779868346683</ts>"
      "<status>OK</status><msg-version>2.3.0</msg-version><op>inventory</op><data><advanNetId>"
      "AdvanNet-instance-64:cf:d9:c7:56:1c--1</advanNetId><deviceId>AdvanReader-m4-160</deviceId><inventory>"
      "<class>INVENTORY</class><deviceId>AdvanReader-m4-160</deviceId><size>{}</size><items>{}</items>"
      "</inventory></data></inventory>",
      kItems, items);
}

long long number(std::string_view text) {
  long long value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

void take_property(std::string_view text, reader::TagRead& read) {
  const std::size_t colon = text.find(':');
  const std::string_view name = text.substr(0, colon);
  const std::string_view value = text.substr(colon + 1);
  if (name == "RSSI") read.rssi_dbm = static_cast<std::int16_t>(number(value));
  if (name == "ANTENNA_PORT") read.port = static_cast<std::uint8_t>(number(value));
  if (name == "RF_PHASE") read.phase_deg = static_cast<double>(number(value));
  if (name == "FREQ") read.frequency_khz = static_cast<std::uint32_t>(number(value));
  if (name == "READ_COUNT") read.read_count = static_cast<std::uint32_t>(number(value));
}

struct Contest {
  const std::string body = message();
  reader::AdvanNetMessage decoded;
  std::string work;
  std::vector<reader::TagRead> reads;

  void ours() {
    keep(reader::decode_advannet_message(body, decoded).has_value());
    keep(decoded.reads.data());
  }
  // The fastest way pugixml has: a tree in place, with its least features. It writes into its input, so the
  // message is copied first, as a socket would have delivered it.
  void other() {
    work = body;
    reads.clear();
    pugi::xml_document document;
    if (!document.load_buffer_inplace(work.data(), work.size(), pugi::parse_minimal, pugi::encoding_utf8))
      return;
    const auto items = document.child("inventory").child("data").child("inventory").child("items");
    for (const auto& item : items.children("item")) {
      reader::TagRead read;
      read.epc = reader::Epc::from_hex(item.child_value("epc")).value_or(reader::Epc{});
      read.reader_ms = number(item.child_value("ts"));
      for (const auto& prop : item.child("data").child("props").children("prop"))
        take_property(prop.child_value(), read);
      reads.push_back(read);
    }
    keep(reads.data());
  }
  bool agree() {
    ours();
    other();
    const auto values = [](const reader::TagRead& r) {
      return std::tuple(r.epc, r.port, r.rssi_dbm, r.phase_deg, r.frequency_khz, r.read_count, r.reader_ms);
    };
    return decoded.reads.size() == kItems &&
           std::equal(reads.begin(), reads.end(), decoded.reads.begin(), decoded.reads.end(),
                      [&](const auto& a, const auto& b) { return values(a) == values(b); });
  }
};

}  // namespace

Duel advannet_duel() {
  const auto contest = std::make_shared<Contest>();
  return {.name = "AdvanNet event decode",
          .unit = "events/s",
          .peer = "pugixml, in place",
          .items = kItems,
          .ours = [contest] { contest->ours(); },
          .other = [contest] { contest->other(); },
          .agree = [contest] { return contest->agree(); }};
}

}  // namespace forager::tools
