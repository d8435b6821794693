#include "mocks/fake_pose_source.hpp"

#include <utility>

namespace forager::mocks {

hal::Result<std::optional<hal::PoseSample>> FakePoseSource::do_poll(hal::Instant now) {
  if (next_error_) return hal::fail(*std::exchange(next_error_, std::nullopt));
  if (disconnected_)
    return hal::fail(hal::ErrorCode::disconnected, "fake pose source", "poll", "the cable is out");
  std::optional<hal::PoseSample> newest;
  while (!waiting_.empty() && waiting_.front().stamp + latency_ <= now) {
    newest = waiting_.front();
    waiting_.pop_front();
  }
  return newest;
}

}  // namespace forager::mocks
