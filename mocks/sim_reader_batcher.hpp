#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/random.hpp"
#include "hal/time.hpp"
#include "mocks/sim_reader_config.hpp"
#include "mocks/sim_reader_events.hpp"

namespace forager::mocks {

// Collects reads before they are sent: the more tags a second, the longer, with hysteresis (AdvanNet event
// dispatcher):  <= 25 -> 10 ms, 25..75 -> 30, 50..150 -> 50, 100..250 -> 100, > 200 -> 150 ms.
// Also where reads are folded, doubled, made late and preceded by old ones, as the faults say; and the cache
// of the last time window that /inventory answers from.
class SimReaderBatcher {
 public:
  SimReaderBatcher(const SimReaderFaults& faults, std::uint64_t seed);

  // Forgets everything (power-up).
  void reset();
  // The radio has gone on: the stale reads of the faults are due again.
  void started(std::int64_t reader_ms);
  // Reads older than `window` before the newest need not be kept.
  void add(const AirRead& read, std::int64_t reader_ms, hal::Duration window);
  // The batch to send, in the order heard, or empty; valid until the next call.
  [[nodiscard]] std::span<const SimReadEvent> take_due(hal::Instant now);
  // Reads of the last `window`, folded to one per tag and port (latest read, count of all) unless keep_all.
  [[nodiscard]] std::vector<SimReadEvent> recent(hal::Instant now, hal::Duration window, bool keep_all) const;
  [[nodiscard]] hal::Duration delay() const;

 private:
  void queue(const SimReadEvent& event);
  void count(hal::Instant at);

  const SimReaderFaults* faults_;
  hal::Random random_;
  std::vector<SimReadEvent> pending_;
  std::vector<SimReadEvent> sending_;
  struct Late {
    SimReadEvent event;
    hal::Instant release;
  };
  std::vector<Late> late_;
  std::vector<SimReadEvent> cache_;
  std::size_t cache_limit_ = 0;
  hal::Instant due_;
  int stale_left_ = 0;
  std::int64_t started_ms_ = 0;
  std::array<int, 4> bins_{};  // reads in the last four quarters of a second
  std::size_t bin_ = 0;
  hal::Instant bin_end_;
  std::size_t level_ = 0;
};

}  // namespace forager::mocks
