#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hal/random.hpp"
#include "mocks/gen2_field_link.hpp"

namespace forager::mocks {

// The tags that could answer from about here, each with an upper bound of its hazard rate that holds within
// half a metre and for any attitude; renewed after a quarter of a metre.
class SlotCandidates {
 public:
  struct Candidate {
    std::uint32_t tag;
    double bound_per_s;
    double sum_per_s;  // of all bounds up to and with this one
  };

  explicit SlotCandidates(std::size_t tags) { all_.reserve(tags); }

  // max_reach: the largest AntennaView::reach of the ports in use.
  void refresh_if_moved(const AirLink& link, std::size_t tags, hal::Vec3 position, double max_reach);
  void forget() { at_.reset(); }

  [[nodiscard]] const std::vector<Candidate>& all() const { return all_; }
  [[nodiscard]] double sum_per_s() const { return all_.empty() ? 0.0 : all_.back().sum_per_s; }
  // One of them, in proportion to its bound. There must be one.
  [[nodiscard]] const Candidate& pick(hal::Random& random) const;

 private:
  std::vector<Candidate> all_;
  std::optional<hal::Vec3> at_;
};

}  // namespace forager::mocks
