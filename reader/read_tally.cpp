#include "reader/read_tally.hpp"

#include <algorithm>

namespace forager::reader {

std::optional<double> ReadCount::mean_rssi_dbm() const {
  if (rssi_reads == 0) return std::nullopt;
  return rssi_sum_dbm / static_cast<double>(rssi_reads);
}

void ReadCount::add(std::int16_t rssi_dbm, bool new_tag) {
  ++reads;
  if (new_tag) ++tags;
  if (rssi_dbm == TagRead::kNoRssi) return;
  ++rssi_reads;
  rssi_sum_dbm += rssi_dbm;
  strongest_dbm = std::max(strongest_dbm, rssi_dbm);
}

ReadTally::ReadTally(std::span<const ReadPort> ports) : planned_(!ports.empty()), tags_(1024) {
  for (const ReadPort& port : ports) ports_.push_back({port.port, port.name, {}, {}, {}});
}

std::size_t ReadTally::index_of(std::uint8_t port) {
  const auto found = std::ranges::find(ports_, port, &Port::port);
  if (found != ports_.end()) return static_cast<std::size_t>(found - ports_.begin());
  ports_.push_back({port, planned_ ? "not in the plan" : "port " + std::to_string(port), {}, {}, {}});
  return ports_.size() - 1;
}

void ReadTally::add(std::span<const TagRead> reads) {
  for (const TagRead& read : reads) {
    const std::size_t index = index_of(read.port);
    const std::uint64_t bit = std::uint64_t{1} << (index % 64);
    const auto [seen, first] = tags_.insert(read.epc, Seen{});
    if (seen->interval != interval_number_) {
      seen->interval = interval_number_;
      seen->interval_ports = 0;
    }
    Port& port = ports_[index];
    port.total.add(read.rssi_dbm, (seen->ports & bit) == 0);
    port.interval.add(read.rssi_dbm, (seen->interval_ports & bit) == 0);
    total_.add(read.rssi_dbm, first);
    interval_.add(read.rssi_dbm, seen->interval_ports == 0);
    if (first) ++new_tags_;
    seen->ports |= bit;
    seen->interval_ports |= bit;
    port.last_heard = std::max(port.last_heard.value_or(read.heard), read.heard);
    last_heard_ = std::max(last_heard_.value_or(read.heard), read.heard);
  }
}

void ReadTally::next_interval() {
  ++interval_number_;
  new_tags_ = 0;
  interval_ = {};
  for (Port& port : ports_) port.interval = {};
}

}  // namespace forager::reader
