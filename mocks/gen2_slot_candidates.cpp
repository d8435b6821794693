#include "mocks/gen2_slot_candidates.hpp"

#include <algorithm>

namespace forager::mocks {
namespace {

// The difference is what the body may move in a round.
constexpr double kSlack_m = 0.5;
constexpr double kMove_m = 0.25;

}  // namespace

void SlotCandidates::refresh_if_moved(const AirLink& link, std::size_t tags, hal::Vec3 position,
                                      double max_reach) {
  if (at_ && norm(position - *at_) < kMove_m) return;
  at_ = position;
  all_.clear();
  double sum = 0.0;
  for (std::uint32_t tag = 0; tag < tags; ++tag) {
    const double bound = link.hazard_bound(position, kSlack_m, max_reach, tag);
    if (bound <= 0.0) continue;
    sum += bound;
    all_.push_back({tag, bound, sum});
  }
}

const SlotCandidates::Candidate& SlotCandidates::pick(hal::Random& random) const {
  const double pick = random.uniform() * sum_per_s();
  const auto above = [](double value, const Candidate& c) { return value < c.sum_per_s; };
  return *std::min(std::upper_bound(all_.begin(), all_.end(), pick, above), all_.end() - 1);
}

}  // namespace forager::mocks
