#include "hal/linux/jitter.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace forager::hal {

// Below 16 ns every nanosecond has a bucket of its own; above, the octave and its four bits after the leading
// one choose.
std::size_t Jitter::bucket_of(std::uint64_t ns) {
  if (ns < kSteps) return static_cast<std::size_t>(ns);
  const int octave = static_cast<int>(std::bit_width(ns)) - 5;  // 0 for 16..31
  const std::uint64_t step = (ns >> octave) - kSteps;
  const std::size_t bucket = static_cast<std::size_t>(octave + 1) * kSteps + static_cast<std::size_t>(step);
  return std::min(bucket, std::size_t{kSteps * kOctaves - 1});
}

std::uint64_t Jitter::top_of(std::size_t bucket) {
  if (bucket < kSteps) return bucket;
  const std::size_t octave = bucket / kSteps - 1;
  return ((kSteps + bucket % kSteps + 1) << octave) - 1;
}

void Jitter::add(Duration late) {
  const std::int64_t ns = std::max<std::int64_t>(0, late.count());
  buckets_[bucket_of(static_cast<std::uint64_t>(ns))].fetch_add(1, std::memory_order_relaxed);
  count_.fetch_add(1, std::memory_order_relaxed);
  if (ns > max_ns_.load(std::memory_order_relaxed)) max_ns_.store(ns, std::memory_order_relaxed);
}

Duration Jitter::quantile(double share) const {
  const std::uint64_t all = count();
  const double wanted = std::ceil(std::clamp(share, 0.0, 1.0) * static_cast<double>(all));
  std::uint64_t seen = 0;
  for (std::size_t bucket = 0; all > 0 && bucket < buckets_.size(); ++bucket) {
    seen += buckets_[bucket].load(std::memory_order_relaxed);
    if (seen > 0 && static_cast<double>(seen) >= wanted)
      return std::min(Duration(static_cast<std::int64_t>(top_of(bucket))), max());
  }
  return {};
}

}  // namespace forager::hal
