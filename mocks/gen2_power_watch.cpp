#include "mocks/gen2_power_watch.hpp"

#include <algorithm>
#include <cmath>

#include "hal/units.hpp"

namespace forager::mocks {
namespace {

constexpr double kPeriod_s = 0.5;
constexpr double kMove_m = 0.05;
constexpr double kTurn_rad = 0.035;

}  // namespace

void PowerWatch::update(double t_s, const hal::Pose& pose, const AirLink& link,
                        const std::vector<RadioPort>& ports, std::size_t tags, SessionFlags& flags) {
  if (at_ && t_s - at_s_ < kPeriod_s) return;
  if (at_ && norm(pose.position - at_->position) < kMove_m &&
      std::abs(hal::angle_difference(pose.yaw_rad, at_->yaw_rad)) < kTurn_rad)
    return;
  at_ = pose;
  at_s_ = t_s;
  views_.clear();
  for (const RadioPort& port : ports) views_.push_back(link.view(pose, port));
  for (std::uint32_t tag = 0; tag < tags; ++tag) {
    if (!flags.holds(tag)) continue;
    const auto reaches = [&](const AntennaView& view) { return std::isfinite(link.link(view, tag).u); };
    flags.set_power(tag, std::any_of(views_.begin(), views_.end(), reaches), t_s);
  }
}

void PowerWatch::all_off(double t_s, std::size_t tags, SessionFlags& flags) {
  for (std::uint32_t tag = 0; tag < tags; ++tag)
    if (flags.holds(tag)) flags.set_power(tag, false, t_s);
}

}  // namespace forager::mocks
