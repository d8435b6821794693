#include "servo/pulse_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace forager::servo {
namespace {

using namespace std::chrono_literals;

constexpr hal::Duration kShortest = 1us;
constexpr hal::Duration kLongest = 1s;

hal::Failure refuse(std::string why, std::string mend = {}) {
  return hal::fail(hal::ErrorCode::invalid_argument, "pulse map", "create", std::move(why), std::move(mend));
}

bool rises(const PulsePoint& before, const PulsePoint& after) { return after.pulse > before.pulse; }

}  // namespace

hal::Result<PulseMap> PulseMap::create(std::vector<PulsePoint> points) {
  if (points.size() < 2) return refuse("fewer than two points");
  for (const PulsePoint& point : points) {
    if (!std::isfinite(point.at)) return refuse("a point that is not a finite number");
    if (point.pulse < kShortest || point.pulse > kLongest)
      return refuse(fmt::format("a pulse of {} ns; from 1 us to 1 s makes sense", point.pulse.count()));
  }
  for (std::size_t i = 1; i < points.size(); ++i) {
    const PulsePoint& before = points[i - 1];
    const PulsePoint& after = points[i];
    if (!(after.at > before.at) || !std::isfinite(after.at - before.at))
      return refuse(fmt::format("{} after {}", after.at, before.at), "Give the points in rising order");
    if (after.pulse == before.pulse || rises(before, after) != rises(points[0], points[1]))
      return refuse(fmt::format("{} ns after {} ns", after.pulse.count(), before.pulse.count()),
                    "Pulses must rise from point to point, or fall from point to point");
  }
  return PulseMap(std::move(points));
}

hal::Result<PulseMap> PulseMap::between(PulsePoint from, PulsePoint to) { return create({from, to}); }

hal::Result<hal::Duration> PulseMap::pulse(double at) const {
  if (std::isnan(at))
    return hal::fail(hal::ErrorCode::invalid_argument, "pulse map", "look up", "not a number was commanded");
  if (at <= first()) return points_.front().pulse;
  if (at >= last()) return points_.back().pulse;
  const auto after = std::upper_bound(points_.begin(), points_.end(), at,
                                      [](double value, const PulsePoint& point) { return value < point.at; });
  const PulsePoint& to = *after;
  const PulsePoint& from = *std::prev(after);
  const double share = (at - from.at) / (to.at - from.at);
  const auto span_ns = static_cast<double>((to.pulse - from.pulse).count());
  return from.pulse + hal::Duration(std::llround(share * span_ns));
}

double PulseMap::at(hal::Duration pulse) const {
  const bool rising = rises(points_.front(), points_.back());
  const auto beyond = [rising](hal::Duration a, hal::Duration b) { return rising ? a >= b : a <= b; };
  if (!beyond(pulse, points_.front().pulse)) return first();
  if (beyond(pulse, points_.back().pulse)) return last();
  std::size_t i = 1;
  while (beyond(pulse, points_[i].pulse)) ++i;
  const PulsePoint& from = points_[i - 1];
  const PulsePoint& to = points_[i];
  const double share = static_cast<double>((pulse - from.pulse).count()) /
                       static_cast<double>((to.pulse - from.pulse).count());
  return from.at + share * (to.at - from.at);
}

}  // namespace forager::servo
