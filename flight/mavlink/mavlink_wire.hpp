#pragma once

#include <cstddef>
#include <cstdint>

// Numbers of the MAVLink wire that both a bridge and an emulated autopilot need; nothing here can encode or
// decode. Sources: MAVLink serialization, message signing, common.xml, ardupilotmega.xml; ArduCopter 4.6
// modes.
namespace forager::flight::mavlink {

// Framing. v1: STX len seq sysid compid id payload crc(2).
// v2: STX len incompat compat seq sysid compid id(3) payload crc(2) [signature(13)].
inline constexpr std::uint8_t kStxV1 = 0xFE;
inline constexpr std::uint8_t kStxV2 = 0xFD;
inline constexpr std::size_t kHeaderV1 = 6;
inline constexpr std::size_t kHeaderV2 = 10;
inline constexpr std::size_t kCrcSize = 2;
inline constexpr std::size_t kSignatureSize = 13;  // link id 1, timestamp 6, hash 6
inline constexpr std::size_t kMaxPayload = 255;
inline constexpr std::size_t kMaxFrame = kHeaderV2 + kMaxPayload + kCrcSize + kSignatureSize;
inline constexpr std::uint8_t kIncompatSigned = 0x01;
inline constexpr std::uint8_t kProtocolVersion = 3;  // HEARTBEAT.mavlink_version, of v1 and v2 alike

// Signing time: units of 10 us since 2015-01-01 00:00 UTC.
inline constexpr std::int64_t kSigningEpochUnixSeconds = 1'420'070'400;
inline constexpr std::uint64_t kSigningUnitsPerSecond = 100'000;
inline constexpr std::uint64_t kSigningMaxAge = 60 * kSigningUnitsPerSecond;

namespace component {  // MAV_COMPONENT
inline constexpr std::uint8_t kAll = 0;
inline constexpr std::uint8_t kAutopilot = 1;
inline constexpr std::uint8_t kMissionPlanner = 190;
inline constexpr std::uint8_t kOnboardComputer = 191;
inline constexpr std::uint8_t kVisualInertialOdometry = 197;
}  // namespace component

namespace vehicle_type {  // MAV_TYPE
inline constexpr std::uint8_t kGeneric = 0;
inline constexpr std::uint8_t kQuadrotor = 2;
inline constexpr std::uint8_t kGroundStation = 6;
inline constexpr std::uint8_t kGroundRover = 10;
inline constexpr std::uint8_t kHexarotor = 13;
inline constexpr std::uint8_t kOnboardController = 18;
}  // namespace vehicle_type

namespace autopilot_type {  // MAV_AUTOPILOT
inline constexpr std::uint8_t kGeneric = 0;
inline constexpr std::uint8_t kArdupilot = 3;
inline constexpr std::uint8_t kInvalid = 8;  // "not an autopilot": what a companion says of itself
inline constexpr std::uint8_t kPx4 = 12;
}  // namespace autopilot_type

namespace mode_flag {  // MAV_MODE_FLAG, HEARTBEAT.base_mode
inline constexpr std::uint8_t kCustomMode = 1;
inline constexpr std::uint8_t kGuided = 8;
inline constexpr std::uint8_t kStabilize = 16;
inline constexpr std::uint8_t kManualInput = 64;
inline constexpr std::uint8_t kSafetyArmed = 128;
}  // namespace mode_flag

namespace system_state {  // MAV_STATE
inline constexpr std::uint8_t kUninit = 0;
inline constexpr std::uint8_t kBoot = 1;
inline constexpr std::uint8_t kCalibrating = 2;
inline constexpr std::uint8_t kStandby = 3;
inline constexpr std::uint8_t kActive = 4;
inline constexpr std::uint8_t kCritical = 5;
inline constexpr std::uint8_t kEmergency = 6;
}  // namespace system_state

namespace copter_mode {  // ArduCopter custom_mode
inline constexpr std::uint32_t kStabilize = 0;
inline constexpr std::uint32_t kAltHold = 2;
inline constexpr std::uint32_t kAuto = 3;
inline constexpr std::uint32_t kGuided = 4;
inline constexpr std::uint32_t kLoiter = 5;
inline constexpr std::uint32_t kReturnToLaunch = 6;
inline constexpr std::uint32_t kLand = 9;
inline constexpr std::uint32_t kBrake = 17;
inline constexpr std::uint32_t kGuidedNoGps = 20;
}  // namespace copter_mode

namespace landed_state {  // MAV_LANDED_STATE
inline constexpr std::uint8_t kUndefined = 0;
inline constexpr std::uint8_t kOnGround = 1;
inline constexpr std::uint8_t kInAir = 2;
inline constexpr std::uint8_t kTakeoff = 3;
inline constexpr std::uint8_t kLanding = 4;
}  // namespace landed_state

namespace command {  // MAV_CMD
inline constexpr std::uint16_t kNavLand = 21;
inline constexpr std::uint16_t kNavTakeoff = 22;
inline constexpr std::uint16_t kConditionYaw = 115;
inline constexpr std::uint16_t kDoSetMode = 176;
inline constexpr std::uint16_t kDoSetHome = 179;
inline constexpr std::uint16_t kDoSetServo = 183;
inline constexpr std::uint16_t kDoMotorTest = 209;
inline constexpr std::uint16_t kRebootShutdown = 246;
inline constexpr std::uint16_t kArmDisarm = 400;
inline constexpr std::uint16_t kRunPrearmChecks = 401;
inline constexpr std::uint16_t kGetMessageInterval = 510;
inline constexpr std::uint16_t kSetMessageInterval = 511;
inline constexpr std::uint16_t kRequestMessage = 512;
inline constexpr std::uint16_t kRequestAutopilotCapabilities = 520;
inline constexpr float kForceDisarm = 21196.0F;  // param2 of kArmDisarm: disarms in flight, too
}  // namespace command

namespace result {  // MAV_RESULT
inline constexpr std::uint8_t kAccepted = 0;
inline constexpr std::uint8_t kTemporarilyRejected = 1;
inline constexpr std::uint8_t kDenied = 2;
inline constexpr std::uint8_t kUnsupported = 3;
inline constexpr std::uint8_t kFailed = 4;
inline constexpr std::uint8_t kInProgress = 5;
inline constexpr std::uint8_t kCancelled = 6;
}  // namespace result

namespace frame_id {  // MAV_FRAME
inline constexpr std::uint8_t kGlobal = 0;
inline constexpr std::uint8_t kLocalNed = 1;
inline constexpr std::uint8_t kGlobalRelativeAlt = 3;
inline constexpr std::uint8_t kLocalOffsetNed = 7;
inline constexpr std::uint8_t kBodyNed = 8;
inline constexpr std::uint8_t kBodyOffsetNed = 9;
inline constexpr std::uint8_t kBodyFrd = 12;
inline constexpr std::uint8_t kLocalFrd = 20;
}  // namespace frame_id

// POSITION_TARGET_TYPEMASK: a set bit means "ignore". ArduCopter drops a whole triple for any bit of it.
namespace target_mask {
inline constexpr std::uint16_t kIgnorePosition = 0x0007;
inline constexpr std::uint16_t kIgnoreVelocity = 0x0038;
inline constexpr std::uint16_t kIgnoreAcceleration = 0x01C0;
inline constexpr std::uint16_t kForce = 0x0200;
inline constexpr std::uint16_t kIgnoreYaw = 0x0400;
inline constexpr std::uint16_t kIgnoreYawRate = 0x0800;
inline constexpr std::uint16_t kPositionAndYaw = kIgnoreVelocity | kIgnoreAcceleration | kIgnoreYawRate;
inline constexpr std::uint16_t kVelocityAndYawRate = kIgnorePosition | kIgnoreAcceleration | kIgnoreYaw;
}  // namespace target_mask

// ATTITUDE_TARGET_TYPEMASK: a set bit means "ignore". ArduCopter wants all three rates or none, and drops a
// message that ignores thrust.
namespace attitude_mask {
inline constexpr std::uint8_t kIgnoreRates = 0x07;
inline constexpr std::uint8_t kIgnoreThrottle = 0x40;
inline constexpr std::uint8_t kIgnoreAttitude = 0x80;
}  // namespace attitude_mask

namespace severity {  // MAV_SEVERITY, smaller is worse
inline constexpr std::uint8_t kCritical = 2;
inline constexpr std::uint8_t kError = 3;
inline constexpr std::uint8_t kWarning = 4;
inline constexpr std::uint8_t kNotice = 5;
inline constexpr std::uint8_t kInfo = 6;
}  // namespace severity

}  // namespace forager::flight::mavlink
