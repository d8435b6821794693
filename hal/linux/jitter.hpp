#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "hal/time.hpp"

namespace forager::hal {

// How late something came, as a distribution: 16 steps to the octave, so a quantile is right to 6 %; the
// largest is exact. One thread adds, any may read meanwhile. Never allocates.
class Jitter {
 public:
  void add(Duration late);  // negative counts as nothing
  [[nodiscard]] std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }
  // The smallest step that at least this share (0..1) of all do not exceed; zero before the first.
  [[nodiscard]] Duration quantile(double share) const;
  [[nodiscard]] Duration max() const { return Duration(max_ns_.load(std::memory_order_relaxed)); }

 private:
  static constexpr int kSteps = 16;
  static constexpr int kOctaves = 40;  // to 18 minutes

  [[nodiscard]] static std::size_t bucket_of(std::uint64_t ns);
  [[nodiscard]] static std::uint64_t top_of(std::size_t bucket);

  std::array<std::atomic<std::uint64_t>, kSteps * kOctaves> buckets_{};
  std::atomic<std::uint64_t> count_{0};
  std::atomic<std::int64_t> max_ns_{0};
};

}  // namespace forager::hal
