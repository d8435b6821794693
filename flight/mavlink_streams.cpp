#include "flight/mavlink_streams.hpp"

#include <algorithm>

#include "flight/mavlink/messages_motion.hpp"
#include "flight/mavlink/messages_vehicle.hpp"

namespace forager::flight {
namespace {

constexpr hal::Duration kFirstPause = 1s;
constexpr hal::Duration kLongestPause = 8s;

}  // namespace

MavlinkStreams::MavlinkStreams(const MavlinkConfig& config) {
  streams_[0].id = mavlink::LocalPositionNed::kId;
  streams_[0].interval = config.pose_stream_interval;
  streams_[1].id = mavlink::Attitude::kId;
  streams_[1].interval = config.pose_stream_interval;
  streams_[2].id = mavlink::ExtendedSysState::kId;
  streams_[2].interval = config.landed_stream_interval;
  streams_[3].id = mavlink::SysStatus::kId;
  streams_[3].interval = config.battery_stream_interval;
  streams_[4].id = mavlink::BatteryStatus::kId;
  streams_[4].interval = config.battery_stream_interval;
}

void MavlinkStreams::heard(std::uint32_t id, hal::Instant now) {
  for (Stream& stream : streams_)
    if (stream.id == id) stream.last_heard = now;
}

void MavlinkStreams::restart() {
  for (Stream& stream : streams_) stream.pause = hal::Duration::zero();
}

std::optional<mavlink::CommandLong> MavlinkStreams::due(hal::Instant now) {
  for (Stream& stream : streams_) {
    const bool first = stream.pause == hal::Duration::zero();
    if (!first) {
      const hal::Duration patience = std::max<hal::Duration>(3 * stream.interval, kFirstPause);
      if (now - stream.last_heard < patience) {
        stream.pause = kFirstPause;
        stream.next_ask = stream.last_heard + patience;
        continue;
      }
      if (now < stream.next_ask) continue;
    }
    stream.next_ask = now + (first ? kFirstPause : stream.pause);
    stream.pause = first ? kFirstPause : std::min<hal::Duration>(2 * stream.pause, kLongestPause);
    mavlink::CommandLong ask;
    ask.command = mavlink::command::kSetMessageInterval;
    ask.param1 = static_cast<float>(stream.id);
    ask.param2 = static_cast<float>(std::chrono::duration<double, std::micro>(stream.interval).count());
    return ask;
  }
  return std::nullopt;
}

}  // namespace forager::flight
