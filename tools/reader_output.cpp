#include "tools/reader_output.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace forager::tools {
namespace {

using Json = nlohmann::ordered_json;
using reader::ReadCount;
using reader::ReadTally;

double rounded(double value) { return std::round(value * 10.0) / 10.0; }

std::optional<double> age_s(const std::optional<hal::Instant>& heard, hal::Instant now) {
  if (!heard) return std::nullopt;
  return hal::to_seconds(now - *heard);
}
std::string age_text(const std::optional<hal::Instant>& heard, hal::Instant now) {
  const auto age = age_s(heard, now);
  return age ? fmt::format("{:.1f} s ago", *age) : "never";
}
std::string rssi_text(std::optional<double> dbm) { return dbm ? fmt::format("{:.0f} dBm", *dbm) : "-"; }
std::string strongest_text(const ReadCount& count) {
  return count.rssi_reads > 0 ? fmt::format("{} dBm", count.strongest_dbm) : "-";
}
Json or_null(std::optional<double> value) { return value ? Json(rounded(*value)) : Json(nullptr); }

Json json_of(const ReadTally::Port& port, const ReadCount& count, double seconds, hal::Instant now) {
  return {{"port", port.port},
          {"name", port.name},
          {"reads_s", rounded(static_cast<double>(count.reads) / seconds)},
          {"tags_s", rounded(static_cast<double>(count.tags) / seconds)},
          {"reads", port.total.reads},
          {"tags", port.total.tags},
          {"rssi_dbm", or_null(count.mean_rssi_dbm())},
          {"strongest_dbm", count.rssi_reads > 0 ? Json(count.strongest_dbm) : Json(nullptr)},
          {"age_s", or_null(age_s(port.last_heard, now))}};
}

Json json_of(const ReaderMoment& moment, bool whole) {
  const ReadTally& tally = moment.tally;
  const double seconds = hal::to_seconds(whole ? moment.now.time_since_epoch() : moment.interval);
  const ReadCount& count = whole ? tally.total() : tally.interval();
  Json ports = Json::array();
  for (const auto& port : tally.ports())
    ports.push_back(json_of(port, whole ? port.total : port.interval, seconds, moment.now));
  Json out{{"event", whole ? "end" : "reads"},
           {"t_s", hal::to_seconds(moment.now)},
           {"link", to_string(moment.link.phase)},
           {"rounds", whole ? moment.counters.inventories : moment.inventories},
           {"reads_s", rounded(static_cast<double>(count.reads) / seconds)},
           {"tags_s", rounded(static_cast<double>(count.tags) / seconds)}};
  if (!whole) out["new_tags"] = tally.new_tags();
  out["reads"] = tally.total().reads;
  out["tags"] = tally.total().tags;
  out["rssi_dbm"] = or_null(count.mean_rssi_dbm());
  out["age_s"] = or_null(age_s(tally.last_heard(), moment.now));
  out["why_none"] = moment.why.empty() ? Json(nullptr) : Json(moment.why);
  if (whole) {
    const auto& counters = moment.counters;
    out["link_losses"] = moment.link.losses;
    out["dropped"] = {
        {"stale", counters.stale}, {"bad_items", counters.bad_items}, {"malformed", counters.malformed}};
  }
  out["ports"] = std::move(ports);
  return out;
}

// The table; `whole`: of everything since the start, else of the interval.
std::vector<std::string> table_of(const ReaderMoment& moment, bool whole) {
  const ReadTally& tally = moment.tally;
  const double seconds = hal::to_seconds(whole ? moment.now.time_since_epoch() : moment.interval);
  std::vector<std::string> lines{fmt::format("{:<4}  {:<16} {:>9} {:>9} {:>9} {:>7} {:>9} {:>10}  {}", "port",
                                             "name", "reads/s", "tags/s", "reads", "tags", "RSSI",
                                             "strongest", "last heard")};
  const auto add = [&](const std::string& port, const std::string& name, const ReadCount& rate,
                       const ReadCount& total, const std::optional<hal::Instant>& heard) {
    lines.push_back(fmt::format(
        "{:<4}  {:<16} {:>9.1f} {:>9.1f} {:>9} {:>7} {:>9} {:>10}  {}", port, name,
        static_cast<double>(rate.reads) / seconds, static_cast<double>(rate.tags) / seconds, total.reads,
        total.tags, rssi_text(rate.mean_rssi_dbm()), strongest_text(rate), age_text(heard, moment.now)));
  };
  for (const auto& port : tally.ports())
    add(fmt::format("{}", port.port), port.name, whole ? port.total : port.interval, port.total,
        port.last_heard);
  add("all", "", whole ? tally.total() : tally.interval(), tally.total(), tally.last_heard());
  return lines;
}

std::string headline(const ReaderMoment& moment) {
  const auto& link = moment.link;
  return fmt::format("{:.1f} s  link {} for {:.1f} s, {} rounds", hal::to_seconds(moment.now),
                     to_string(link.phase), hal::to_seconds(moment.now - link.since), moment.inventories);
}

std::string line_of(const ReaderMoment& moment) {
  const ReadTally& tally = moment.tally;
  const double seconds = hal::to_seconds(moment.interval);
  std::string line = fmt::format(
      "{:9.1f} s  link {:<7}  rounds {:>3}  reads/s {:>6.1f}  tags/s {:>6.1f}  new {:>4}  tags {:>5} ",
      hal::to_seconds(moment.now), to_string(moment.link.phase), moment.inventories,
      static_cast<double>(tally.interval().reads) / seconds,
      static_cast<double>(tally.interval().tags) / seconds, tally.new_tags(), tally.total().tags);
  for (const auto& port : tally.ports())
    line += fmt::format(" | {} {:.1f}/s {}", port.name, static_cast<double>(port.interval.reads) / seconds,
                        rssi_text(port.interval.mean_rssi_dbm()));
  return line;
}

}  // namespace

void ReaderOutput::note(hal::Instant now, std::string_view source, std::string_view text) {
  out_.record({{"event", "note"}, {"t_s", hal::to_seconds(now)}, {"source", source}, {"text", text}});
  out_.line(fmt::format("{:9.1f} s  {}: {}", hal::to_seconds(now), source, text));
}

void ReaderOutput::moment(const ReaderMoment& moment) {
  if (out_.json()) return out_.record(json_of(moment, false));
  if (live_) {
    auto lines = table_of(moment, false);
    lines.insert(lines.begin(), headline(moment));
    lines.push_back(moment.why.empty() ? "" : "none: " + moment.why);
    return out_.live(lines);
  }
  out_.line(line_of(moment));
  // Once for every reason: it stands until reads or another reason come.
  if (moment.why != last_why_ && !moment.why.empty()) out_.line("             none: " + moment.why);
  last_why_ = moment.why;
}

void ReaderOutput::end(const ReaderMoment& moment) {
  if (out_.json()) return out_.record(json_of(moment, true));
  out_.line(fmt::format("in {:.1f} s, {} rounds:", hal::to_seconds(moment.now), moment.counters.inventories));
  for (const std::string& line : table_of(moment, true)) out_.line(line);
  if (moment.tally.total().reads == 0) out_.line("none: " + moment.why);
}

}  // namespace forager::tools
