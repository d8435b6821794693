#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/time.hpp"
#include "reader/epc_table.hpp"
#include "reader/read_plan.hpp"
#include "reader/tag_read.hpp"

namespace forager::reader {

// What one antenna, or all of them, heard in some time.
struct ReadCount {
  std::uint64_t reads = 0;
  std::uint64_t tags = 0;  // different ones
  std::uint64_t rssi_reads = 0;
  double rssi_sum_dbm = 0.0;  // of those reads
  std::int16_t strongest_dbm = TagRead::kNoRssi;

  // Mean of the reported figures (a mean of decibels, as a person reads them off); empty without any.
  [[nodiscard]] std::optional<double> mean_rssi_dbm() const;
  void add(std::int16_t rssi_dbm, bool new_tag);
};

// Counts reads for a person who watches a reader: in total and in the interval since the last look, over all
// ports and for each.
class ReadTally {
 public:
  struct Port {
    std::uint8_t port = 0;
    std::string name;  // "not in the plan" for one that is not; without a plan "port 3"
    ReadCount total;
    ReadCount interval;
    std::optional<hal::Instant> last_heard;  // time of the newest read, on our time line
  };

  // No ports: there is no plan, and every port is taken as it comes.
  explicit ReadTally(std::span<const ReadPort> ports);

  void add(std::span<const TagRead> reads);
  // Begins an interval.
  void next_interval();

  [[nodiscard]] const ReadCount& total() const { return total_; }
  [[nodiscard]] const ReadCount& interval() const { return interval_; }
  // Tags first heard in this interval.
  [[nodiscard]] std::uint64_t new_tags() const { return new_tags_; }
  [[nodiscard]] std::optional<hal::Instant> last_heard() const { return last_heard_; }
  // In the order of the plan, then strangers in the order they were heard.
  [[nodiscard]] std::span<const Port> ports() const { return ports_; }

 private:
  // Bit i: port i of ports_. Ports beyond the 64th count their tags as one of the first 64 does.
  struct Seen {
    std::uint64_t ports = 0;
    std::uint64_t interval_ports = 0;
    std::uint64_t interval = 0;  // that interval_ports is of
  };
  std::size_t index_of(std::uint8_t port);

  bool planned_;
  std::vector<Port> ports_;
  EpcTable<Seen> tags_;
  ReadCount total_;
  ReadCount interval_;
  std::uint64_t new_tags_ = 0;
  std::uint64_t interval_number_ = 1;
  std::optional<hal::Instant> last_heard_;
};

}  // namespace forager::reader
