#include "mocks/gen2_slot_round.hpp"

#include <cmath>
#include <utility>

namespace forager::mocks {
namespace {

// Replies in a slot with this mean and above are counted tag by tag: e^-mean must not vanish.
constexpr double kFullSlot = 600.0;

std::size_t binomial(hal::Random& random, std::size_t n, std::uint32_t slots) {
  if (slots <= 1) return n;
  const double p = 1.0 / slots;
  const auto count = static_cast<double>(n);
  if (count * p >= kFullSlot) {
    std::size_t k = 0;
    for (std::size_t i = 0; i < n; ++i) k += random.chance(p) ? 1U : 0U;
    return k;
  }
  // Inversion: cost of the result.
  const double odds = p / (1.0 - p);
  double term = std::exp(count * std::log1p(-p));
  double rest = random.uniform();
  std::size_t k = 0;
  while (rest >= term && k < n) {
    rest -= term;
    term *= odds * static_cast<double>(n - k) / static_cast<double>(k + 1);
    ++k;
  }
  return k;
}

}  // namespace

void SlotRound::start(QAlgorithm q) {
  q_ = q;
  frame_q_ = q.q();
  slots_left_ = 1U << frame_q_;
  waiting_ = answering_ = 0;
  collision_in_frame_ = over_ = false;
  command_ = SlotCommand::query;
}

std::span<const std::uint32_t> SlotRound::open_slot(hal::Random& random) {
  answering_ = binomial(random, tags_.size() - waiting_, slots_left_);
  for (std::size_t i = 0; i < answering_; ++i) {
    const std::size_t at = waiting_ + i;
    std::swap(tags_[at], tags_[at + random.below(tags_.size() - at)]);
  }
  return answering();
}

void SlotRound::remove_answering(std::size_t i) {
  const std::size_t last = waiting_ + answering_ - 1;
  std::swap(tags_[waiting_ + i], tags_[last]);
  std::swap(tags_[last], tags_.back());
  tags_.pop_back();
  --answering_;
}

void SlotRound::heard_nothing() {
  q_.empty();
  close(true);
}

void SlotRound::heard_collision() {
  q_.collided();
  collision_in_frame_ = true;
  close(false);
}

void SlotRound::heard_one(std::size_t i) {
  remove_answering(i);
  // Whoever was drowned out by it is still there: the reader learns of it at the end.
  if (answering_ > 0) collision_in_frame_ = true;
  close(false);
}

void SlotRound::close(bool empty) {
  waiting_ += answering_;
  answering_ = 0;
  --slots_left_;
  if (!q_.fixed() && empty && frame_q_ == 0) {
    over_ = true;
  } else if (q_.q() != frame_q_) {
    command_ = SlotCommand::query_adjust;
  } else if (slots_left_ == 0) {
    if (q_.fixed() && !collision_in_frame_) over_ = true;
    command_ = SlotCommand::query;
  } else {
    command_ = SlotCommand::query_rep;
    return;
  }
  frame_q_ = q_.q();
  slots_left_ = 1U << frame_q_;
  waiting_ = 0;
  collision_in_frame_ = false;
}

}  // namespace forager::mocks
