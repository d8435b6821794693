#pragma once

#include <optional>
#include <vector>

#include "mocks/gen2_field_flags.hpp"
#include "mocks/gen2_field_link.hpp"

namespace forager::mocks {

// Tells the flags of S2, S3 and SL which tags get power from any port of the reader. While the body rests
// nothing changes, so it looks only after a move of 5 cm or 2 degrees, and every half a second at most: short
// against the 2 s that those flags outlast power at least.
class PowerWatch {
 public:
  void forget() { at_.reset(); }
  void update(double t_s, const hal::Pose& pose, const AirLink& link, const std::vector<RadioPort>& ports,
              std::size_t tags, SessionFlags& flags);
  // The carrier is gone for all.
  static void all_off(double t_s, std::size_t tags, SessionFlags& flags);

 private:
  std::vector<AntennaView> views_;
  std::optional<hal::Pose> at_;
  double at_s_ = 0.0;
};

}  // namespace forager::mocks
