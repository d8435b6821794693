#pragma once

#include <span>
#include <string>
#include <vector>

#include "hal/byte_stream.hpp"
#include "hal/journal.hpp"
#include "reader/advannet_events.hpp"
#include "reader/advannet_reader.hpp"
#include "reader/advannet_stream.hpp"
#include "reader/backoff.hpp"
#include "reader/tag_reader.hpp"

namespace forager::reader {

// Listens to the event stream of an AdvanReader that runs for somebody else, and does nothing but that: no
// request is sent, nothing is set up, started or stopped. The stream needs no login and no word from its
// client; it has room for four of them, and this takes one (AdvanNet event stream).
//
//   closed --start()--> opening --connected--> open --silence, disconnect--> lost --back-off--> opening
//   any --halt()--> closed: the reader goes on
//
// Nobody asks the reader for its clock, so a read counts as heard when it arrived. Whether the reader runs it
// does not say either: keep-alives come from one that is stopped, too.
class AdvanNetListener final : public TagReader {
 public:
  // References must outlive it. Of the configuration the time-out of a request is that of connecting.
  AdvanNetListener(hal::ByteStream& events, hal::Journal& journal, const AdvanNetConfig& config);

  void start(hal::Instant now) override;
  void update(hal::Instant now) override;
  void halt() noexcept override;
  [[nodiscard]] std::span<const TagRead> reads() const override { return reads_; }
  [[nodiscard]] const LinkStatus& link() const override { return link_; }
  // Inventories, reads, malformed, bad items, unknown and reconnects; the others stay 0.
  [[nodiscard]] const AdvanNetCounters& counters() const { return counters_; }

 private:
  void enter(LinkPhase phase, std::string reason);
  void lose(std::string reason);
  void connect();
  void take_in();
  void take_frames();
  void take_message();

  hal::ByteStream* events_;
  hal::Journal* journal_;
  AdvanNetConfig config_;
  Backoff backoff_;
  AdvanNetStream stream_;
  AdvanNetMessage message_;
  AdvanNetCounters counters_;
  std::vector<TagRead> reads_;
  LinkStatus link_;
  hal::Instant now_;
  hal::Deadline wait_;  // opening: for the connection; lost: until the next try
  hal::Instant heard_;  // the newest frame
  bool was_open_ = false;
};

}  // namespace forager::reader
