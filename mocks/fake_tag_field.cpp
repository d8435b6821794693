#include "mocks/fake_tag_field.hpp"

#include <algorithm>

namespace forager::mocks {

// Replies in the time the radio was off were heard by nobody.
void FakeTagField::skip_until(hal::Instant now) {
  while (next_ < replies_.size() && replies_[next_].at <= now) ++next_;
}

void FakeTagField::radio_on(const RadioSettings& settings, hal::Instant now) {
  skip_until(now);
  settings_ = settings;
  on_ = true;
  ++times_on_;
}

void FakeTagField::radio_off(hal::Instant now) {
  skip_until(now);
  on_ = false;
}

void FakeTagField::advance(hal::Instant now, std::vector<AirRead>& out) {
  for (; on_ && next_ < replies_.size() && replies_[next_].at <= now; ++next_) {
    const auto uses = [this](const RadioPort& port) { return port.port == replies_[next_].port; };
    if (std::ranges::any_of(settings_.ports, uses)) out.push_back(replies_[next_]);
  }
}

}  // namespace forager::mocks
