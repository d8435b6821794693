#pragma once

#include <cmath>
#include <cstdint>

namespace forager::boards {

// Mean and variance of numbers as they come (Welford 1962): no sum of squares whose difference cancels. Two
// of them merge exactly as if one had seen all (Chan, Golub, LeVeque 1983).
class RunningMoments {
 public:
  void add(double value) {
    ++count_;
    const double before = value - mean_;
    mean_ += before / static_cast<double>(count_);
    squares_ += before * (value - mean_);
  }
  void merge(const RunningMoments& other) {
    if (other.count_ == 0) return;
    const double ours = static_cast<double>(count_);
    const double theirs = static_cast<double>(other.count_);
    const double apart = other.mean_ - mean_;
    count_ += other.count_;
    mean_ += apart * (theirs / (ours + theirs));
    squares_ += other.squares_ + apart * apart * (ours * theirs / (ours + theirs));
  }
  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] double mean() const { return mean_; }
  // Of the population the numbers are a sample of; 0 for fewer than two.
  [[nodiscard]] double variance() const {
    return count_ < 2 ? 0.0 : squares_ / static_cast<double>(count_ - 1);
  }
  // Standard deviation of the mean.
  [[nodiscard]] double standard_error() const {
    return count_ < 2 ? 0.0 : std::sqrt(variance() / static_cast<double>(count_));
  }

 private:
  std::uint64_t count_ = 0;
  double mean_ = 0.0;
  double squares_ = 0.0;
};

}  // namespace forager::boards
