// From event stream bytes to tag reads, per event, at 1 and 20 items a message, against the same job done
// with a pugixml tree parsed in place with its least features.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <charconv>
#include <cstring>
#include <pugixml.hpp>
#include <string>

#include "reader/advannet_events.hpp"
#include "reader/advannet_stream.hpp"

namespace forager::reader {
namespace {

std::string message_of(int items) {
  std::string list;
  for (int i = 0; i < items; ++i)
    list += fmt::format(
        "<item><class>READ_EVENT</class><epc>3034257bf7194e40{0:08x}</epc><decoded></decoded>"
        "<ts>{1}</ts><deviceId>AdvanReader-m4-160</deviceId><data><class>TAG_DATA</class>"
        "<hexepc>3034257bf7194e40{0:08x}</hexepc><tid></tid><data></data><props><prop>TIME_STAMP:{1}</prop>"
        "<prop>RSSI:-{2}</prop><prop>RF_PHASE:45</prop><prop>ANTENNA_PORT:{3}</prop><prop>MUX1:0</prop>"
        "<prop>MUX2:0</prop><prop>FREQ:866300</prop><prop>GPI:{{0:0:0:0}}</prop><prop>READ_COUNT:1</prop>"
        "</props></data><location><class>LOCATION_DEFINITION</class><loc></loc><ts></ts></location></item>",
        i, 1779868346683 + i, 40 + i % 40, 1 + i % 4);
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<inventory><type>inventory</type><ts>1779868346683</ts>"
      "<status>OK</status><msg-version>2.3.0</msg-version><op>inventory</op><data><advanNetId>"
      "AdvanNet-instance-64:cf:d9:c7:56:1c--1</advanNetId><deviceId>AdvanReader-m4-160</deviceId><inventory>"
      "<class>INVENTORY</class><deviceId>AdvanReader-m4-160</deviceId><size>{}</size><items>{}</items>"
      "</inventory></data></inventory>",
      items, list);
}

void set_rates(benchmark::State& state, std::size_t bytes) {
  const auto events = static_cast<double>(state.iterations()) * static_cast<double>(state.range(0));
  state.counters["event"] =
      benchmark::Counter(events, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(bytes));
}

void decode(benchmark::State& state) {
  const std::string body = message_of(static_cast<int>(state.range(0)));
  AdvanNetMessage message;
  for (auto _ : state) {
    if (!decode_advannet_message(body, message)) state.SkipWithError("not decoded");
    benchmark::DoNotOptimize(message.reads.data());
  }
  set_rates(state, body.size());
}

void frame_and_decode(benchmark::State& state) {
  const std::string body = message_of(static_cast<int>(state.range(0)));
  const std::string frame = fmt::format(
      "ADVANNET/1.1\r\nContent-Length:{}\r\nContent-Type:text/xml\r\n\r\n{}\r\n\r\n", body.size(), body);
  AdvanNetStream stream;
  AdvanNetMessage message;
  for (auto _ : state) {
    for (std::string_view rest = frame; !rest.empty();) {
      const auto room = stream.room();
      const std::size_t size = std::min(room.size(), rest.size());
      std::memcpy(room.data(), rest.data(), size);
      stream.commit(size);
      rest.remove_prefix(size);
      while (const auto found = *stream.next())
        if (!decode_advannet_message(*found, message)) state.SkipWithError("not decoded");
    }
    benchmark::DoNotOptimize(message.reads.data());
  }
  set_rates(state, frame.size());
}

long long number(std::string_view text) {
  long long value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

void pugixml_in_place(benchmark::State& state) {
  const std::string body = message_of(static_cast<int>(state.range(0)));
  std::string work;
  std::vector<TagRead> reads;
  for (auto _ : state) {
    work = body;  // parsing in place destroys its input; the driver's buffer would be fresh each time
    reads.clear();
    pugi::xml_document document;
    if (!document.load_buffer_inplace(work.data(), work.size(), pugi::parse_minimal, pugi::encoding_utf8))
      state.SkipWithError("not parsed");
    const auto items = document.child("inventory").child("data").child("inventory").child("items");
    for (const auto& item : items.children("item")) {
      TagRead read;
      read.epc = Epc::from_hex(item.child_value("epc")).value_or(Epc{});
      read.reader_ms = number(item.child_value("ts"));
      for (const auto& prop : item.child("data").child("props").children("prop")) {
        const std::string_view text = prop.child_value();
        const std::size_t colon = text.find(':');
        const std::string_view name = text.substr(0, colon);
        const std::string_view value = text.substr(colon + 1);
        if (name == "RSSI") read.rssi_dbm = static_cast<std::int16_t>(number(value));
        if (name == "ANTENNA_PORT") read.port = static_cast<std::uint8_t>(number(value));
        if (name == "RF_PHASE") read.phase_deg = static_cast<double>(number(value));
        if (name == "FREQ") read.frequency_khz = static_cast<std::uint32_t>(number(value));
        if (name == "READ_COUNT") read.read_count = static_cast<std::uint32_t>(number(value));
      }
      reads.push_back(read);
    }
    benchmark::DoNotOptimize(reads.data());
  }
  set_rates(state, body.size());
}

BENCHMARK(decode)->Arg(1)->Arg(20);
BENCHMARK(frame_and_decode)->Arg(1)->Arg(20);
BENCHMARK(pugixml_in_place)->Arg(1)->Arg(20);

}  // namespace
}  // namespace forager::reader

BENCHMARK_MAIN();
