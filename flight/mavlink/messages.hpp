#pragma once

#include <cstddef>

#include "flight/mavlink/messages_channels.hpp"
#include "flight/mavlink/messages_command.hpp"
#include "flight/mavlink/messages_link.hpp"
#include "flight/mavlink/messages_motion.hpp"
#include "flight/mavlink/messages_sensing.hpp"
#include "flight/mavlink/messages_setpoint.hpp"
#include "flight/mavlink/messages_vehicle.hpp"

namespace forager::flight::mavlink {

template <Message... Ms>
struct MessageList {
  static constexpr std::size_t kSize = sizeof...(Ms);
};

// Every message this codec knows, by ascending id.
using AllMessages =
    MessageList<Heartbeat, SysStatus, SystemTime, Ping, SetMode, ParamRequestRead, ParamRequestList,
                ParamValue, ParamSet, Attitude, AttitudeQuaternion, LocalPositionNed, GlobalPositionInt,
                ServoOutputRaw, SetGpsGlobalOrigin, GpsGlobalOrigin, RcChannels, ManualControl,
                RcChannelsOverride, VfrHud, CommandInt, CommandLong, CommandAck, CommandCancel,
                SetAttitudeTarget, AttitudeTarget, SetPositionTargetLocalNed, PositionTargetLocalNed,
                SetPositionTargetGlobalInt, VisionPositionEstimate, VisionSpeedEstimate, SimState,
                RadioStatus, Timesync, DistanceSensor, BatteryStatus, AutopilotVersion, EkfStatusReport,
                HomePosition, SetHomePosition, MessageInterval, ExtendedSysState, NamedValueFloat, Statustext,
                SetupSigning, ObstacleDistance, Odometry, ParamError, CurrentMode, EscTelemetry1To4>;

}  // namespace forager::flight::mavlink
