#include "mocks/fake_digital_in.hpp"

namespace forager::mocks {

void FakeDigitalIn::drive(bool active, hal::Instant now) {
  constexpr std::size_t kKernelQueue = 16;  // Linux gpiolib: default size of a line's event queue
  if (active == active_) return;
  active_ = active;
  if (edges_.size() < kKernelQueue) edges_.push_back({now, active});
}

hal::Result<> FakeDigitalIn::admit(std::string_view operation) {
  if (next_error_) return hal::fail(*std::exchange(next_error_, std::nullopt));
  if (disconnected_)
    return hal::fail(hal::ErrorCode::disconnected, name_, std::string(operation), "the cable is out");
  return {};
}

hal::Result<bool> FakeDigitalIn::do_active() {
  FORAGER_TRY(admit("read"));
  return active_;
}

hal::Result<std::size_t> FakeDigitalIn::do_edges(std::span<hal::Edge> into) {
  FORAGER_TRY(admit("read edges"));
  std::size_t count = 0;
  for (; count < into.size() && !edges_.empty(); ++count) {
    into[count] = edges_.front();
    edges_.pop_front();
  }
  return count;
}

}  // namespace forager::mocks
