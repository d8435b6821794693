#include "mocks/gen2_field_dwell.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace forager::mocks {
namespace {

// ETSI EN 302 208, lower band: the four high-power channels.
constexpr std::uint32_t kChannels_khz[] = {865700, 866300, 866900, 867500};
constexpr double kShortestDwell_s = 1e-3;

}  // namespace

void DwellSchedule::start(const RadioSettings& settings, double now_s) {
  ports_ = settings.ports.size();
  on_s_ = hal::to_seconds(settings.on_time);
  off_s_ = hal::to_seconds(settings.off_time);
  const bool pauses = on_s_ > 0.0 && off_s_ > 0.0;
  on_until_s_ = pauses ? now_s + on_s_ : std::numeric_limits<double>::infinity();
  dwell_.port_index = 0;
  begin(now_s);
}

void DwellSchedule::advance() {
  dwell_.port_index = (dwell_.port_index + 1) % ports_;
  double start_s = dwell_.end_s;
  if (start_s >= on_until_s_) {
    start_s = on_until_s_ + off_s_;
    on_until_s_ = start_s + on_s_;
  }
  begin(start_s);
}

void DwellSchedule::begin(double start_s) {
  ++dwell_.id;
  channel_ = (channel_ + 1 + random_.below(3)) % 4;  // never the same one twice in a row
  dwell_.frequency_khz = kChannels_khz[channel_];
  dwell_.start_s = start_s;
  patience_s_ = std::clamp(air_.patience_median_s * std::exp(air_.patience_log_sigma * random_.normal()),
                           kShortestDwell_s, air_.max_dwell_s);
  latest_end_s_ = std::min(start_s + air_.max_dwell_s, on_until_s_);
  dwell_.end_s = std::min(start_s + air_.settle_s + patience_s_, latest_end_s_);
}

void DwellSchedule::prolong(double now_s) {
  dwell_.end_s = std::clamp(now_s + patience_s_, dwell_.end_s, latest_end_s_);
}

void DwellSchedule::leave(double now_s) { dwell_.end_s = std::clamp(now_s, dwell_.start_s, latest_end_s_); }

}  // namespace forager::mocks
