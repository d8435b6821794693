#include "boards/pin_loopback.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace forager::boards {
namespace {

constexpr hal::Duration kSettle = std::chrono::milliseconds(20);

}  // namespace

bool PinLoopback::end(std::string fault) {
  result_.fault = std::move(fault);
  return false;
}

hal::Result<> PinLoopback::toggle(hal::Instant now) {
  level_ = !level_;
  toggled_ = now;
  seen_ = false;
  ++result_.toggles;
  return out_->set(level_);
}

hal::Result<> PinLoopback::take_edges() {
  std::array<hal::Edge, 16> edges;
  const auto count = in_->edges(edges);
  if (!count) return hal::fail(count.error());
  for (std::size_t i = 0; i < *count; ++i) {
    if (seen_ || !toggled_) {
      ++result_.extra;
      continue;
    }
    seen_ = true;
    ++result_.edges;
    level_right_ = edges[i].active == level_;
    result_.latency.push_back(std::max(edges[i].at - *toggled_, hal::Duration::zero()));
  }
  return {};
}

hal::Result<bool> PinLoopback::update(hal::Instant now) {
  if (!settle_) {  // the output has just become inactive: edges of that are nobody's
    FORAGER_TRY(out_->set(false));
    settle_ = now;
    return true;
  }
  if (!toggled_) {
    std::array<hal::Edge, 16> old;
    if (const auto dropped = in_->edges(old); !dropped) return hal::fail(dropped.error());
    if (now - *settle_ < kSettle) return true;
    const auto active = in_->active();
    if (!active) return hal::fail(active.error());
    FORAGER_TRY(toggle(now));
    return true;
  }
  FORAGER_TRY(take_edges());
  if (seen_ && !level_right_) {
    FORAGER_TRY(out_->set(false));
    return end("the input goes the other way: one of the two is active-low");
  }
  if (!seen_ && now - *toggled_ > config_.wait) {
    FORAGER_TRY(out_->set(false));
    return end(result_.edges == 0 ? "no edge came: the two pins are not wired together"
                                  : fmt::format("edge {} of {} did not come: a loose contact",
                                                result_.toggles, config_.toggles));
  }
  if (!seen_) return true;
  if (result_.toggles >= config_.toggles) {
    FORAGER_TRY(out_->set(false));
    return end(result_.extra == 0
                   ? std::string()
                   : fmt::format("{} edges came that nobody caused: noise, or a bad contact", result_.extra));
  }
  FORAGER_TRY(toggle(now));
  return true;
}

}  // namespace forager::boards
