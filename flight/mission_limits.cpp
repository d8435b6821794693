#include "flight/mission_limits.hpp"

namespace forager::flight {

Verdict judge(const MissionLimits& limits, const Vitals& v) {
  const auto longer = [&](const std::optional<hal::Instant>& since, hal::Duration allowed) {
    return since && v.now - *since >= allowed;
  };
  if (!v.autopilot_link_up)
    return {Consequence::fall_silent, EndReason::autopilot_lost, "no heartbeat from the autopilot"};
  if (!v.armed)
    return {Consequence::hands_off, EndReason::autopilot_mode, "the autopilot disarmed in flight"};
  if (!v.guided)
    return {Consequence::hands_off, EndReason::autopilot_mode,
            "the autopilot left GUIDED: not ours any more"};
  if (v.halt_asked) return {Consequence::land, EndReason::halted, "asked to stop"};
  if (longer(v.pose_bad_since, limits.pose_allowance))
    return {Consequence::land, EndReason::pose_lost, "no trustworthy pose"};
  if (v.battery_fraction && *v.battery_fraction < limits.battery_reserve)
    return {Consequence::land, EndReason::battery, "battery below its reserve"};
  if (v.reader_failed) return {Consequence::land, EndReason::reader_lost, "the reader needs a person"};
  if (longer(v.reader_lost_since, limits.reader_allowance))
    return {Consequence::land, EndReason::reader_lost, "the reader did not come back"};
  if (longer(v.store_failing_since, limits.store_allowance))
    return {Consequence::land, EndReason::store_failed, "the inventory cannot be stored"};
  if (limits.flight_time && longer(v.airborne_since, *limits.flight_time))
    return {Consequence::land, EndReason::time_limit, "flight time used up"};
  return {};
}

}  // namespace forager::flight
