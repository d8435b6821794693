#include "mocks/sim_reader_batcher.hpp"

#include <algorithm>
#include <numeric>

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;

struct Level {
  int low;   // tags a second below which the next shorter delay does
  int high;  // above which the next longer one is needed
  hal::Duration delay;
};
constexpr std::array<Level, 5> kLevels{
    {{0, 25, 10ms}, {25, 75, 30ms}, {50, 150, 50ms}, {100, 250, 100ms}, {200, 1'000'000'000, 150ms}}};
constexpr hal::Duration kBin = 250ms;
constexpr std::size_t kCacheFloor = 256;
constexpr std::int64_t kStaleMaxMs = 2000;

}  // namespace

SimReaderBatcher::SimReaderBatcher(const SimReaderFaults& faults, std::uint64_t seed)
    : faults_(&faults), random_(hal::Random::stream(seed, 1)), cache_limit_(kCacheFloor) {}

void SimReaderBatcher::reset() {
  pending_.clear();
  late_.clear();
  cache_.clear();
  cache_limit_ = kCacheFloor;
  bins_ = {};
  level_ = 0;
  stale_left_ = 0;
}

void SimReaderBatcher::started(std::int64_t reader_ms) {
  stale_left_ = faults_->stale_reads_after_start;
  started_ms_ = reader_ms;
}

hal::Duration SimReaderBatcher::delay() const { return kLevels[level_].delay; }

void SimReaderBatcher::count(hal::Instant at) {
  if (at >= bin_end_ + 4 * kBin) {
    bins_ = {};
    bin_end_ = at + kBin;
  }
  while (at >= bin_end_) {
    bin_ = (bin_ + 1) % bins_.size();
    bins_[bin_] = 0;
    bin_end_ += kBin;
  }
  ++bins_[bin_];
  const int rate = std::accumulate(bins_.begin(), bins_.end(), 0);
  while (rate > kLevels[level_].high) ++level_;
  while (rate < kLevels[level_].low) --level_;
}

void SimReaderBatcher::queue(const SimReadEvent& event) {
  if (pending_.empty()) due_ = event.read.at + delay();
  pending_.push_back(event);
}

void SimReaderBatcher::add(const AirRead& read, std::int64_t reader_ms, hal::Duration window) {
  const auto happens = [this](double chance) { return chance > 0.0 && random_.chance(chance); };
  count(read.at);
  SimReadEvent event{read, reader_ms, 1, happens(faults_->comma_props)};
  if (cache_.size() >= cache_limit_) {
    std::erase_if(cache_, [&](const SimReadEvent& old) { return old.read.at < read.at - window; });
    cache_limit_ = std::max(kCacheFloor, 2 * cache_.size());
  }
  cache_.push_back(event);
  if (stale_left_ > 0) {
    --stale_left_;
    SimReadEvent stale = event;
    stale.reader_ms = started_ms_ - 1 - static_cast<std::int64_t>(random_.below(kStaleMaxMs));
    queue(stale);
  }
  if (happens(faults_->out_of_order)) {
    late_.push_back(
        {event, read.at + hal::from_seconds(hal::to_seconds(faults_->out_of_order_max) * random_.uniform())});
    return;
  }
  queue(event);
  if (happens(faults_->duplicate)) queue(event);
}

std::span<const SimReadEvent> SimReaderBatcher::take_due(hal::Instant now) {
  std::erase_if(late_, [this, now](const Late& late) {
    if (late.release > now) return false;
    if (pending_.empty()) due_ = now;
    pending_.push_back(late.event);
    return true;
  });
  if (pending_.empty() || now < due_) return {};
  sending_.swap(pending_);
  pending_.clear();
  return sending_;
}

std::vector<SimReadEvent> SimReaderBatcher::recent(hal::Instant now, hal::Duration window,
                                                   bool keep_all) const {
  std::vector<SimReadEvent> reads;
  for (const SimReadEvent& event : cache_) {
    if (event.read.at < now - window) continue;
    const auto same = std::ranges::find_if(reads, [&event](const SimReadEvent& seen) {
      return seen.read.tag == event.read.tag && seen.read.port == event.read.port;
    });
    if (keep_all || same == reads.end()) {
      reads.push_back(event);
    } else {
      const std::int64_t counted = same->read_count + 1;
      *same = event;
      same->read_count = counted;
    }
  }
  return reads;
}

}  // namespace forager::mocks
