#pragma once

#include <string>
#include <vector>

#include "hal/time.hpp"
#include "reader/advannet_reader.hpp"
#include "reader/read_tally.hpp"
#include "tools/bench_session.hpp"

namespace forager::tools {

// One moment of a watched reader.
struct ReaderMoment {
  hal::Instant now;
  hal::Duration interval{};
  const reader::LinkStatus& link;
  const reader::AdvanNetCounters& counters;
  const reader::ReadTally& tally;
  std::uint64_t inventories = 0;  // in the interval
  std::string why;                // no tag was heard in it; empty: some were
};

// Prints what `forager reader watch` sees: a table that is written over at a terminal, one line an interval
// elsewhere, or JSON lines; and at the end a table of the whole.
class ReaderOutput {
 public:
  explicit ReaderOutput(bool json) : out_(json), live_(!json && LiveView::possible()) {}

  void note(hal::Instant now, std::string_view source, std::string_view text);
  void moment(const ReaderMoment& moment);
  void end(const ReaderMoment& moment);

 private:
  BenchOutput out_;
  bool live_;
  std::string last_why_;
};

}  // namespace forager::tools
