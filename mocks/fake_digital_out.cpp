#include "mocks/fake_digital_out.hpp"

#include <utility>

namespace forager::mocks {

hal::Result<> FakeDigitalOut::do_set(bool active) {
  if (next_error_) return hal::fail(*std::exchange(next_error_, std::nullopt));
  if (disconnected_) return hal::fail(hal::ErrorCode::disconnected, name_, "set", "the cable is out");
  ++sets_;
  if (active == active_) return {};
  active_ = active;
  edges_.push_back({now_, active});
  if (journal_ != nullptr) journal_->note(now_, name_, active ? "active" : "inactive");
  return {};
}

}  // namespace forager::mocks
