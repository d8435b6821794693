#pragma once

#include <algorithm>
#include <cmath>

namespace forager::mocks {

// The slot-count algorithm of Gen2 annex D: a floating Q follows what the reader sees, one step of C down for
// an empty slot, one up for a collision. Neither C nor the first value is in the standard.
class QAlgorithm {
 public:
  static constexpr double kMaxQ = 15.0;

  // first_q 0..15, step 0..1 (0: fixed Q).
  QAlgorithm(double first_q, double step) : q_(first_q), step_(step) {}

  [[nodiscard]] int q() const { return static_cast<int>(std::lround(q_)); }
  [[nodiscard]] double floating() const { return q_; }
  [[nodiscard]] bool fixed() const { return step_ <= 0.0; }
  void empty() { q_ = std::max(0.0, q_ - step_); }
  void collided() { q_ = std::min(kMaxQ, q_ + step_); }

 private:
  double q_;
  double step_;
};

}  // namespace forager::mocks
