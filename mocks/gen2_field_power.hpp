#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mocks/gen2_field_flags.hpp"
#include "mocks/gen2_field_link.hpp"
#include "mocks/gen2_field_nearby.hpp"

namespace forager::mocks {

// Tells the flags of S2, S3 and SL which tags get power from any port of the reader. It knows the few that
// have power and looks for others within reach only, so its cost does not grow with the world. While the body
// rests nothing changes: it looks after a move of 5 cm or 2 degrees, and every half a second at most, which
// is short against the 2 s that those flags outlast power at least. Without a power-up limit a tag beyond the
// hazard cut counts as unpowered.
class PoweredTags {
 public:
  explicit PoweredTags(std::size_t tags);

  // The tag was singulated in a session that keeps its flag while powered.
  void singulated(std::uint32_t tag);
  void forget() { at_.reset(); }
  void update(double t_s, const hal::Pose& pose, double max_reach, const AirLink& link,
              const NearbyTags& nearby, const std::vector<RadioPort>& ports, SessionFlags& flags);
  // The carrier is gone for all.
  void all_off(double t_s, SessionFlags& flags);

 private:
  std::vector<std::uint8_t> has_power_;  // by tag
  std::vector<std::uint32_t> powered_;
  std::vector<AntennaView> views_;
  std::optional<hal::Pose> at_;
  double at_s_ = 0.0;
};

}  // namespace forager::mocks
