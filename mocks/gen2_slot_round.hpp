#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hal/random.hpp"
#include "mocks/gen2_q.hpp"

namespace forager::mocks {

enum class SlotCommand : std::uint8_t { query, query_rep, query_adjust };

// The slots of one inventory round over a set of tags that heard its Query. A tag draws its slot evenly from
// the frame; drawn one slot after the other that is: of a arbitrating tags, binomially many with chance
// 1 / (slots left) answer in the next one, any of them alike. So a slot costs its replies, neither the tags
// nor the length of the frame (a test holds this against tags that count slots one by one).
//
// Tags that collide count on below 0 and wait for the next draw: QueryAdjust when Q changes, a new Query when
// the frame ends. With a floating Q the reader knows that nobody is left when a slot at Q 0 stays empty; with
// a fixed one when a frame passes without a collision.
class SlotRound {
 public:
  // Tags at most in a round; allocates here only.
  explicit SlotRound(std::size_t capacity) { tags_.reserve(capacity); }

  // For those that hear the Query, in any order, each once: clear, join, start.
  void clear() { tags_.clear(); }
  void join(std::uint32_t tag) { tags_.push_back(tag); }
  void start(QAlgorithm q);

  // The command that opens the next slot, and the tags that answer it; valid until the verdict.
  [[nodiscard]] SlotCommand command() const { return command_; }
  std::span<const std::uint32_t> open_slot(hal::Random& random);

  [[nodiscard]] std::span<const std::uint32_t> answering() const {
    return {tags_.data() + waiting_, answering_};
  }
  // The i-th of those that answered lost its power: it leaves the round before it is heard.
  void leave(std::size_t i) { remove_answering(i); }

  // The reader's verdict closes the slot.
  void heard_nothing();
  void heard_collision();
  // One tag, the i-th of those that answered; it leaves the round, the others wait.
  void heard_one(std::size_t i);

  [[nodiscard]] bool over() const { return over_; }
  [[nodiscard]] std::size_t tags_left() const { return tags_.size(); }
  [[nodiscard]] const QAlgorithm& q() const { return q_; }

 private:
  void close(bool empty);
  void remove_answering(std::size_t i);

  // [0, waiting_) wait, then answering_ ones answer, the rest arbitrates.
  std::vector<std::uint32_t> tags_;
  std::size_t waiting_ = 0;
  std::size_t answering_ = 0;
  std::uint32_t slots_left_ = 1;
  int frame_q_ = 0;
  bool collision_in_frame_ = false;
  bool over_ = false;
  SlotCommand command_ = SlotCommand::query;
  QAlgorithm q_{4.0, 0.3};
};

}  // namespace forager::mocks
