#include "mocks/gen2_field_power.hpp"

#include <algorithm>
#include <cmath>

#include "hal/units.hpp"

namespace forager::mocks {
namespace {

constexpr std::size_t kUsually = std::size_t{1} << 16U;
constexpr std::size_t kMostPorts = 32;
constexpr double kPeriod_s = 0.5;
constexpr double kMove_m = 0.05;
constexpr double kTurn_rad = 0.035;

}  // namespace

PoweredTags::PoweredTags(std::size_t tags) : has_power_(tags, 0) {
  powered_.reserve(std::min(tags, kUsually));
  views_.reserve(kMostPorts);
}

void PoweredTags::singulated(std::uint32_t tag) {
  if (has_power_[tag] != 0) return;
  has_power_[tag] = 1;
  powered_.push_back(tag);
}

void PoweredTags::update(double t_s, const hal::Pose& pose, double max_reach, const AirLink& link,
                         const NearbyTags& nearby, const std::vector<RadioPort>& ports, SessionFlags& flags) {
  if (at_ && t_s - at_s_ < kPeriod_s) return;
  if (at_ && norm(pose.position - at_->position) < kMove_m &&
      std::abs(hal::angle_difference(pose.yaw_rad, at_->yaw_rad)) < kTurn_rad)
    return;
  at_ = pose;
  at_s_ = t_s;
  views_.clear();
  for (const RadioPort& port : ports) views_.push_back(link.view(pose, port));
  const auto reached = [&](std::uint32_t tag) {
    return std::any_of(views_.begin(), views_.end(),
                       [&](const AntennaView& view) { return std::isfinite(link.link(view, tag).u); });
  };
  std::erase_if(powered_, [&](std::uint32_t tag) {
    if (reached(tag)) return false;
    has_power_[tag] = 0;
    flags.set_power(tag, false, t_s);
    return true;
  });
  nearby.within_power({pose.position, 0.0, max_reach}, [&](std::uint32_t tag) {
    if (!flags.holds(tag) || has_power_[tag] != 0 || !reached(tag)) return;
    flags.set_power(tag, true, t_s);
    singulated(tag);
  });
}

void PoweredTags::all_off(double t_s, SessionFlags& flags) {
  for (const std::uint32_t tag : powered_) {
    has_power_[tag] = 0;
    flags.set_power(tag, false, t_s);
  }
  powered_.clear();
}

}  // namespace forager::mocks
