#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>

#include "flight/mavlink/description.hpp"

// Where the vehicle is to go, and what it made of it. Definitions: MAVLink common.xml and ardupilotmega.xml.
// Members keep the names, order and units of the XML.
namespace forager::flight::mavlink {

// A position, velocity or acceleration to fly to; type_mask bits say what to ignore.
struct SetPositionTargetLocalNed {
  static constexpr std::uint32_t kId = 84;
  static constexpr std::string_view kName = "SET_POSITION_TARGET_LOCAL_NED";

  std::uint32_t time_boot_ms = 0;  // ms
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t coordinate_frame = 0;  // MAV_FRAME
  std::uint16_t type_mask = 0;        // POSITION_TARGET_TYPEMASK
  float x = 0.0F;                     // m
  float y = 0.0F;                     // m
  float z = 0.0F;                     // m
  float vx = 0.0F;                    // m/s
  float vy = 0.0F;                    // m/s
  float vz = 0.0F;                    // m/s
  float afx = 0.0F;                   // m/s/s
  float afy = 0.0F;                   // m/s/s
  float afz = 0.0F;                   // m/s/s
  float yaw = 0.0F;                   // rad
  float yaw_rate = 0.0F;              // rad/s

  static constexpr auto fields() {
    return std::tuple{field("time_boot_ms", &SetPositionTargetLocalNed::time_boot_ms),
                      field("target_system", &SetPositionTargetLocalNed::target_system),
                      field("target_component", &SetPositionTargetLocalNed::target_component),
                      field("coordinate_frame", &SetPositionTargetLocalNed::coordinate_frame),
                      field("type_mask", &SetPositionTargetLocalNed::type_mask),
                      field("x", &SetPositionTargetLocalNed::x),
                      field("y", &SetPositionTargetLocalNed::y),
                      field("z", &SetPositionTargetLocalNed::z),
                      field("vx", &SetPositionTargetLocalNed::vx),
                      field("vy", &SetPositionTargetLocalNed::vy),
                      field("vz", &SetPositionTargetLocalNed::vz),
                      field("afx", &SetPositionTargetLocalNed::afx),
                      field("afy", &SetPositionTargetLocalNed::afy),
                      field("afz", &SetPositionTargetLocalNed::afz),
                      field("yaw", &SetPositionTargetLocalNed::yaw),
                      field("yaw_rate", &SetPositionTargetLocalNed::yaw_rate)};
  }
};

// The target the autopilot is following.
struct PositionTargetLocalNed {
  static constexpr std::uint32_t kId = 85;
  static constexpr std::string_view kName = "POSITION_TARGET_LOCAL_NED";

  std::uint32_t time_boot_ms = 0;     // ms
  std::uint8_t coordinate_frame = 0;  // MAV_FRAME
  std::uint16_t type_mask = 0;        // POSITION_TARGET_TYPEMASK
  float x = 0.0F;                     // m
  float y = 0.0F;                     // m
  float z = 0.0F;                     // m
  float vx = 0.0F;                    // m/s
  float vy = 0.0F;                    // m/s
  float vz = 0.0F;                    // m/s
  float afx = 0.0F;                   // m/s/s
  float afy = 0.0F;                   // m/s/s
  float afz = 0.0F;                   // m/s/s
  float yaw = 0.0F;                   // rad
  float yaw_rate = 0.0F;              // rad/s

  static constexpr auto fields() {
    return std::tuple{field("time_boot_ms", &PositionTargetLocalNed::time_boot_ms),
                      field("coordinate_frame", &PositionTargetLocalNed::coordinate_frame),
                      field("type_mask", &PositionTargetLocalNed::type_mask),
                      field("x", &PositionTargetLocalNed::x),
                      field("y", &PositionTargetLocalNed::y),
                      field("z", &PositionTargetLocalNed::z),
                      field("vx", &PositionTargetLocalNed::vx),
                      field("vy", &PositionTargetLocalNed::vy),
                      field("vz", &PositionTargetLocalNed::vz),
                      field("afx", &PositionTargetLocalNed::afx),
                      field("afy", &PositionTargetLocalNed::afy),
                      field("afz", &PositionTargetLocalNed::afz),
                      field("yaw", &PositionTargetLocalNed::yaw),
                      field("yaw_rate", &PositionTargetLocalNed::yaw_rate)};
  }
};

// A position on the globe to fly to.
struct SetPositionTargetGlobalInt {
  static constexpr std::uint32_t kId = 86;
  static constexpr std::string_view kName = "SET_POSITION_TARGET_GLOBAL_INT";

  std::uint32_t time_boot_ms = 0;  // ms
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t coordinate_frame = 0;  // MAV_FRAME
  std::uint16_t type_mask = 0;        // POSITION_TARGET_TYPEMASK
  std::int32_t lat_int = 0;           // degE7
  std::int32_t lon_int = 0;           // degE7
  float alt = 0.0F;                   // m
  float vx = 0.0F;                    // m/s
  float vy = 0.0F;                    // m/s
  float vz = 0.0F;                    // m/s
  float afx = 0.0F;                   // m/s/s
  float afy = 0.0F;                   // m/s/s
  float afz = 0.0F;                   // m/s/s
  float yaw = 0.0F;                   // rad
  float yaw_rate = 0.0F;              // rad/s

  static constexpr auto fields() {
    return std::tuple{field("time_boot_ms", &SetPositionTargetGlobalInt::time_boot_ms),
                      field("target_system", &SetPositionTargetGlobalInt::target_system),
                      field("target_component", &SetPositionTargetGlobalInt::target_component),
                      field("coordinate_frame", &SetPositionTargetGlobalInt::coordinate_frame),
                      field("type_mask", &SetPositionTargetGlobalInt::type_mask),
                      field("lat_int", &SetPositionTargetGlobalInt::lat_int),
                      field("lon_int", &SetPositionTargetGlobalInt::lon_int),
                      field("alt", &SetPositionTargetGlobalInt::alt),
                      field("vx", &SetPositionTargetGlobalInt::vx),
                      field("vy", &SetPositionTargetGlobalInt::vy),
                      field("vz", &SetPositionTargetGlobalInt::vz),
                      field("afx", &SetPositionTargetGlobalInt::afx),
                      field("afy", &SetPositionTargetGlobalInt::afy),
                      field("afz", &SetPositionTargetGlobalInt::afz),
                      field("yaw", &SetPositionTargetGlobalInt::yaw),
                      field("yaw_rate", &SetPositionTargetGlobalInt::yaw_rate)};
  }
};

// An attitude and thrust to hold; type_mask bits say what to ignore.
struct SetAttitudeTarget {
  static constexpr std::uint32_t kId = 82;
  static constexpr std::string_view kName = "SET_ATTITUDE_TARGET";

  std::uint32_t time_boot_ms = 0;  // ms
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t type_mask = 0;  // ATTITUDE_TARGET_TYPEMASK
  std::array<float, 4> q{};
  float body_roll_rate = 0.0F;   // rad/s
  float body_pitch_rate = 0.0F;  // rad/s
  float body_yaw_rate = 0.0F;    // rad/s
  float thrust = 0.0F;
  // extensions
  std::array<float, 3> thrust_body{};

  static constexpr auto fields() {
    return std::tuple{field("time_boot_ms", &SetAttitudeTarget::time_boot_ms),
                      field("target_system", &SetAttitudeTarget::target_system),
                      field("target_component", &SetAttitudeTarget::target_component),
                      field("type_mask", &SetAttitudeTarget::type_mask),
                      field("q", &SetAttitudeTarget::q),
                      field("body_roll_rate", &SetAttitudeTarget::body_roll_rate),
                      field("body_pitch_rate", &SetAttitudeTarget::body_pitch_rate),
                      field("body_yaw_rate", &SetAttitudeTarget::body_yaw_rate),
                      field("thrust", &SetAttitudeTarget::thrust),
                      extension("thrust_body", &SetAttitudeTarget::thrust_body)};
  }
};

// The attitude the autopilot is holding.
struct AttitudeTarget {
  static constexpr std::uint32_t kId = 83;
  static constexpr std::string_view kName = "ATTITUDE_TARGET";

  std::uint32_t time_boot_ms = 0;  // ms
  std::uint8_t type_mask = 0;      // ATTITUDE_TARGET_TYPEMASK
  std::array<float, 4> q{};
  float body_roll_rate = 0.0F;   // rad/s
  float body_pitch_rate = 0.0F;  // rad/s
  float body_yaw_rate = 0.0F;    // rad/s
  float thrust = 0.0F;

  static constexpr auto fields() {
    return std::tuple{field("time_boot_ms", &AttitudeTarget::time_boot_ms),
                      field("type_mask", &AttitudeTarget::type_mask),
                      field("q", &AttitudeTarget::q),
                      field("body_roll_rate", &AttitudeTarget::body_roll_rate),
                      field("body_pitch_rate", &AttitudeTarget::body_pitch_rate),
                      field("body_yaw_rate", &AttitudeTarget::body_yaw_rate),
                      field("thrust", &AttitudeTarget::thrust)};
  }
};

// Joystick axes -1000..1000; 32767 means not used.
struct ManualControl {
  static constexpr std::uint32_t kId = 69;
  static constexpr std::string_view kName = "MANUAL_CONTROL";

  std::uint8_t target = 0;
  std::int16_t x = 0;
  std::int16_t y = 0;
  std::int16_t z = 0;
  std::int16_t r = 0;
  std::uint16_t buttons = 0;
  // extensions
  std::uint16_t buttons2 = 0;
  std::uint8_t enabled_extensions = 0;
  std::int16_t s = 0;
  std::int16_t t = 0;
  std::int16_t aux1 = 0;
  std::int16_t aux2 = 0;
  std::int16_t aux3 = 0;
  std::int16_t aux4 = 0;
  std::int16_t aux5 = 0;
  std::int16_t aux6 = 0;

  static constexpr auto fields() {
    return std::tuple{field("target", &ManualControl::target),
                      field("x", &ManualControl::x),
                      field("y", &ManualControl::y),
                      field("z", &ManualControl::z),
                      field("r", &ManualControl::r),
                      field("buttons", &ManualControl::buttons),
                      extension("buttons2", &ManualControl::buttons2),
                      extension("enabled_extensions", &ManualControl::enabled_extensions),
                      extension("s", &ManualControl::s),
                      extension("t", &ManualControl::t),
                      extension("aux1", &ManualControl::aux1),
                      extension("aux2", &ManualControl::aux2),
                      extension("aux3", &ManualControl::aux3),
                      extension("aux4", &ManualControl::aux4),
                      extension("aux5", &ManualControl::aux5),
                      extension("aux6", &ManualControl::aux6)};
  }
};

}  // namespace forager::flight::mavlink
