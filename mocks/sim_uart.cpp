#include "mocks/sim_uart.hpp"

#include <algorithm>
#include <array>

namespace forager::mocks {

void SimUart::set_dtr(bool on) {
  if (dtr_ && !on) {
    pump();
    line_->close();
  }
  dtr_ = on;
  pump();
}

bool SimUart::put(std::span<const std::byte> bytes) {
  pump();
  if (sending_limit_ - sending_.size() < bytes.size()) return false;
  sending_.insert(sending_.end(), bytes.begin(), bytes.end());
  pump();
  return true;
}

void SimUart::pump() {
  std::array<std::byte, 256> piece{};
  auto state = line_->poll();
  if (dtr_ && (!state || *state == hal::StreamState::closed)) {
    static_cast<void>(line_->open());
    state = line_->poll();
  }
  if (!state || *state != hal::StreamState::open) {
    sending_.clear();
    return;
  }
  while (!sending_.empty()) {
    const auto written = line_->write(sending_);
    if (written && *written == 0) break;
    const std::size_t gone = written ? *written : sending_.size();
    sending_.erase(sending_.begin(), sending_.begin() + static_cast<std::ptrdiff_t>(gone));
  }
  while (received_.room() > 0) {
    const auto got = line_->read(std::span(piece).first(std::min(piece.size(), received_.room())));
    if (!got || *got == 0) break;
    received_.push(std::span(piece).first(*got));
  }
}

}  // namespace forager::mocks
