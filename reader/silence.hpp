#pragma once

#include <cstdint>
#include <string>

#include "reader/read_plan.hpp"
#include "reader/tag_reader.hpp"

namespace forager::reader {

// What is known when no tag is heard.
struct SilenceFacts {
  LinkStatus link;
  ReadPlan plan;
  std::uint64_t tags_before = 0;    // different tags heard since the start
  std::uint64_t reads_dropped = 0;  // came, and were older than the start by the reader's own clock
  std::uint64_t bad_items = 0;      // came without EPC or time
  std::string reader_says;          // its newest event about itself ("ADVANNET_READER_ERROR: ..."), or empty
};

// Why no tag is heard, the likeliest cause first, one line for the person at the bench; also what to do.
// Looks at the link (down, failed, opening, not started, mute), at reads that came and had to be dropped, at
// what the reader said, at the session (Gen2 v1.2.0 table 6.20: a tag once read in S1 stays silent for 0.5 to
// 5 s, in S2 and S3 for more than 2 s and for as long as it has power), at power and sensitivity, and at last
// at antennas, which an AdvanReader cannot check.
[[nodiscard]] std::string why_silent(const SilenceFacts& facts);

// Reach of a transmit power, relative to 30 dBm: free space, forward link limited.
[[nodiscard]] double relative_reach(double power_dbm);

}  // namespace forager::reader
