#pragma once

#include <array>
#include <cstdint>

// The emulator's own copy of the MAVLink numbers it speaks, typed from common.xml and ardupilotmega.xml, so
// that a slip in the driver's tables cannot hide behind the same slip here.
namespace forager::mocks::peer {

struct MessageKind {
  std::uint32_t id;
  std::uint8_t crc_extra;
  std::uint8_t base_size;  // of a MAVLink 1 payload
  std::uint8_t full_size;  // with all extension fields
};

inline constexpr MessageKind kHeartbeat{0, 50, 9, 9};
inline constexpr MessageKind kSysStatus{1, 124, 31, 43};
inline constexpr MessageKind kSystemTime{2, 137, 12, 12};
inline constexpr MessageKind kSetMode{11, 89, 6, 6};
inline constexpr MessageKind kParamRequestRead{20, 214, 20, 20};
inline constexpr MessageKind kParamValue{22, 220, 25, 25};
inline constexpr MessageKind kParamSet{23, 168, 23, 23};
inline constexpr MessageKind kAttitude{30, 39, 28, 28};
inline constexpr MessageKind kLocalPositionNed{32, 185, 28, 28};
inline constexpr MessageKind kGlobalPositionInt{33, 104, 28, 28};
inline constexpr MessageKind kSetGpsGlobalOrigin{48, 41, 13, 21};
inline constexpr MessageKind kGpsGlobalOrigin{49, 39, 12, 20};
inline constexpr MessageKind kCommandInt{75, 158, 35, 35};
inline constexpr MessageKind kCommandLong{76, 152, 33, 33};
inline constexpr MessageKind kCommandAck{77, 143, 3, 10};
inline constexpr MessageKind kSetAttitudeTarget{82, 49, 39, 51};
inline constexpr MessageKind kSetPositionTargetLocalNed{84, 143, 53, 53};
inline constexpr MessageKind kVisionPositionEstimate{102, 158, 32, 117};
inline constexpr MessageKind kSimState{108, 32, 84, 92};
inline constexpr MessageKind kTimesync{111, 34, 16, 18};
inline constexpr MessageKind kBatteryStatus{147, 154, 36, 54};
inline constexpr MessageKind kAutopilotVersion{148, 178, 60, 78};
inline constexpr MessageKind kEkfStatusReport{193, 71, 22, 26};
inline constexpr MessageKind kMessageInterval{244, 95, 6, 6};
inline constexpr MessageKind kExtendedSysState{245, 130, 2, 2};
inline constexpr MessageKind kStatustext{253, 83, 51, 54};
inline constexpr MessageKind kOdometry{331, 91, 230, 233};

inline constexpr std::array kKnown{kHeartbeat,
                                   kSysStatus,
                                   kSystemTime,
                                   kSetMode,
                                   kParamRequestRead,
                                   kParamValue,
                                   kParamSet,
                                   kAttitude,
                                   kLocalPositionNed,
                                   kGlobalPositionInt,
                                   kSetGpsGlobalOrigin,
                                   kGpsGlobalOrigin,
                                   kCommandInt,
                                   kCommandLong,
                                   kCommandAck,
                                   kSetAttitudeTarget,
                                   kSetPositionTargetLocalNed,
                                   kVisionPositionEstimate,
                                   kSimState,
                                   kTimesync,
                                   kBatteryStatus,
                                   kAutopilotVersion,
                                   kEkfStatusReport,
                                   kMessageInterval,
                                   kExtendedSysState,
                                   kStatustext,
                                   kOdometry};

// MAV_CMD
inline constexpr std::uint16_t kNavReturnToLaunch = 20;
inline constexpr std::uint16_t kNavLand = 21;
inline constexpr std::uint16_t kNavTakeoff = 22;
inline constexpr std::uint16_t kConditionYaw = 115;
inline constexpr std::uint16_t kDoSetMode = 176;
inline constexpr std::uint16_t kDoChangeSpeed = 178;
inline constexpr std::uint16_t kDoSetServo = 183;
inline constexpr std::uint16_t kComponentArmDisarm = 400;
inline constexpr std::uint16_t kRunPrearmChecks = 401;
inline constexpr std::uint16_t kGetMessageInterval = 510;
inline constexpr std::uint16_t kSetMessageInterval = 511;
inline constexpr std::uint16_t kRequestMessage = 512;

// MAV_RESULT
enum class Result : std::uint8_t {
  accepted = 0,
  temporarily_rejected = 1,
  denied = 2,
  unsupported = 3,
  failed = 4,
};

// ArduCopter's custom modes.
enum class CopterMode : std::uint8_t {
  stabilize = 0,
  alt_hold = 2,
  guided = 4,
  loiter = 5,
  rtl = 6,
  land = 9,
  brake = 17,
};

// MAV_FRAME
inline constexpr std::uint8_t kLocalNed = 1;
inline constexpr std::uint8_t kGlobalRelativeAlt = 3;
inline constexpr std::uint8_t kLocalOffsetNed = 7;
inline constexpr std::uint8_t kBodyNed = 8;
inline constexpr std::uint8_t kBodyOffsetNed = 9;
inline constexpr std::uint8_t kBodyFrd = 12;
inline constexpr std::uint8_t kLocalFrd = 20;

// POSITION_TARGET_TYPEMASK: a triple counts as ignored when any of its bits is set.
inline constexpr std::uint16_t kIgnorePosition = 0x007;
inline constexpr std::uint16_t kIgnoreVelocity = 0x038;
inline constexpr std::uint16_t kIgnoreAcceleration = 0x1C0;
inline constexpr std::uint16_t kForceSet = 0x200;
inline constexpr std::uint16_t kIgnoreYaw = 0x400;
inline constexpr std::uint16_t kIgnoreYawRate = 0x800;

// MAV_SEVERITY
inline constexpr std::uint8_t kCritical = 2;
inline constexpr std::uint8_t kWarning = 4;
inline constexpr std::uint8_t kInfo = 6;

}  // namespace forager::mocks::peer
