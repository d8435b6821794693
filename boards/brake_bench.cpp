#include "boards/brake_bench.hpp"

#include <optional>
#include <utility>

#include "boards/autopilot_line.hpp"
#include "boards/brake_devices.hpp"
#include "flight/mavlink_autopilot.hpp"

namespace forager::boards {
namespace {

bool wants_autopilot(const BrakeBoard& board) {
  return board.left.backend == BrakeBackend::autopilot || board.right.backend == BrakeBackend::autopilot;
}

class Bench final : public BrakeBench {
 public:
  Bench(const BrakeBoard& board, hal::Journal& journal) : board_(board), journal_(&journal) {}

  hal::Result<> open(const Board& board, hal::Clock& clock) {
    if (wants_autopilot(board_)) {
      stream_ = open_autopilot_line(board);
      auto motors = bay_.claim("forager brake");  // nobody else may spin them while brakes are tried
      if (!motors) return hal::fail(std::move(motors).error());
      auto link = flight::MavlinkAutopilot::create(*stream_, *journal_, {}, clock.now(), *std::move(motors));
      if (!link) return hal::fail(std::move(link).error());
      autopilot_ = *std::move(link);
    }
    auto devices = open_brake_devices(
        board_,
        {.clock = clock, .journal = *journal_, .autopilot = autopilot_ ? &autopilot_->servos() : nullptr});
    if (!devices) return hal::fail(std::move(devices).error());
    devices_ = *std::move(devices);
    return {};
  }

  hal::Result<> update(hal::Instant now) override {
    if (autopilot_) {
      autopilot_->feed_deadman(now);
      autopilot_->update(now);
    }
    auto updated = devices_->update(now);
    if (pair_) pair_->update(now);
    return updated;
  }
  [[nodiscard]] bool ready() const override { return !autopilot_ || autopilot_->state().link_up; }
  servo::BrakePair& engage(hal::Instant now) override {
    return pair_.emplace(devices_->left(), devices_->right(), *journal_, board_.pair, now);
  }
  [[nodiscard]] std::string left_text() const override { return devices_->left_text(); }
  [[nodiscard]] std::string right_text() const override { return devices_->right_text(); }

 private:
  BrakeBoard board_;
  hal::Journal* journal_;
  flight::MotorBay bay_;
  std::unique_ptr<hal::ByteStream> stream_;
  std::unique_ptr<flight::MavlinkAutopilot> autopilot_;
  std::unique_ptr<BrakeDevices> devices_;
  std::optional<servo::BrakePair> pair_;  // last: it halts before what it borrows is gone
};

}  // namespace

bool all_emulated(const BrakeBoard& board) {
  return board.left.backend == BrakeBackend::sim && board.right.backend == BrakeBackend::sim;
}

hal::Result<std::unique_ptr<BrakeBench>> open_brake_bench(const Board& board, hal::Clock& clock,
                                                          hal::Journal& journal) {
  if (!board.brakes.named && board.kind != BoardKind::sim)
    return hal::fail(hal::ErrorCode::invalid_argument, "board " + board.name, "open brakes",
                     "it has no table [brakes]", "docs/boards.md lists its keys");
  auto bench = std::make_unique<Bench>(board.brakes, journal);
  FORAGER_TRY(bench->open(board, clock));
  return bench;
}

}  // namespace forager::boards
