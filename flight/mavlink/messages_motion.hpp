#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>

#include "flight/mavlink/description.hpp"

// Where the vehicle is and how it moves. Definitions: MAVLink common.xml and ardupilotmega.xml.
// Members keep the names, order and units of the XML.
namespace forager::flight::mavlink {

// Attitude as Euler angles, FRD body in NED; rates in body axes.
struct Attitude {
  static constexpr std::uint32_t kId = 30;
  static constexpr std::string_view kName = "ATTITUDE";

  std::uint32_t time_boot_ms = 0;  // ms
  float roll = 0.0F;               // rad
  float pitch = 0.0F;              // rad
  float yaw = 0.0F;                // rad
  float rollspeed = 0.0F;          // rad/s
  float pitchspeed = 0.0F;         // rad/s
  float yawspeed = 0.0F;           // rad/s

  static constexpr auto fields() {
    return std::tuple{field("time_boot_ms", &Attitude::time_boot_ms),
                      field("roll", &Attitude::roll),
                      field("pitch", &Attitude::pitch),
                      field("yaw", &Attitude::yaw),
                      field("rollspeed", &Attitude::rollspeed),
                      field("pitchspeed", &Attitude::pitchspeed),
                      field("yawspeed", &Attitude::yawspeed)};
  }
};

// Attitude as a quaternion w, x, y, z, FRD body in NED.
struct AttitudeQuaternion {
  static constexpr std::uint32_t kId = 31;
  static constexpr std::string_view kName = "ATTITUDE_QUATERNION";

  std::uint32_t time_boot_ms = 0;  // ms
  float q1 = 0.0F;
  float q2 = 0.0F;
  float q3 = 0.0F;
  float q4 = 0.0F;
  float rollspeed = 0.0F;   // rad/s
  float pitchspeed = 0.0F;  // rad/s
  float yawspeed = 0.0F;    // rad/s
  // extensions
  std::array<float, 4> repr_offset_q{};

  static constexpr auto fields() {
    return std::tuple{field("time_boot_ms", &AttitudeQuaternion::time_boot_ms),
                      field("q1", &AttitudeQuaternion::q1),
                      field("q2", &AttitudeQuaternion::q2),
                      field("q3", &AttitudeQuaternion::q3),
                      field("q4", &AttitudeQuaternion::q4),
                      field("rollspeed", &AttitudeQuaternion::rollspeed),
                      field("pitchspeed", &AttitudeQuaternion::pitchspeed),
                      field("yawspeed", &AttitudeQuaternion::yawspeed),
                      extension("repr_offset_q", &AttitudeQuaternion::repr_offset_q)};
  }
};

// Position and velocity in the local NED frame.
struct LocalPositionNed {
  static constexpr std::uint32_t kId = 32;
  static constexpr std::string_view kName = "LOCAL_POSITION_NED";

  std::uint32_t time_boot_ms = 0;  // ms
  float x = 0.0F;                  // m
  float y = 0.0F;                  // m
  float z = 0.0F;                  // m
  float vx = 0.0F;                 // m/s
  float vy = 0.0F;                 // m/s
  float vz = 0.0F;                 // m/s

  static constexpr auto fields() {
    return std::tuple{field("time_boot_ms", &LocalPositionNed::time_boot_ms),
                      field("x", &LocalPositionNed::x),
                      field("y", &LocalPositionNed::y),
                      field("z", &LocalPositionNed::z),
                      field("vx", &LocalPositionNed::vx),
                      field("vy", &LocalPositionNed::vy),
                      field("vz", &LocalPositionNed::vz)};
  }
};

// Position on the globe; velocities north, east, down.
struct GlobalPositionInt {
  static constexpr std::uint32_t kId = 33;
  static constexpr std::string_view kName = "GLOBAL_POSITION_INT";

  std::uint32_t time_boot_ms = 0;  // ms
  std::int32_t lat = 0;            // degE7
  std::int32_t lon = 0;            // degE7
  std::int32_t alt = 0;            // mm
  std::int32_t relative_alt = 0;   // mm
  std::int16_t vx = 0;             // cm/s
  std::int16_t vy = 0;             // cm/s
  std::int16_t vz = 0;             // cm/s
  std::uint16_t hdg = 0;           // cdeg

  static constexpr auto fields() {
    return std::tuple{field("time_boot_ms", &GlobalPositionInt::time_boot_ms),
                      field("lat", &GlobalPositionInt::lat),
                      field("lon", &GlobalPositionInt::lon),
                      field("alt", &GlobalPositionInt::alt),
                      field("relative_alt", &GlobalPositionInt::relative_alt),
                      field("vx", &GlobalPositionInt::vx),
                      field("vy", &GlobalPositionInt::vy),
                      field("vz", &GlobalPositionInt::vz),
                      field("hdg", &GlobalPositionInt::hdg)};
  }
};

// The truth, from a simulation.
struct SimState {
  static constexpr std::uint32_t kId = 108;
  static constexpr std::string_view kName = "SIM_STATE";

  float q1 = 0.0F;
  float q2 = 0.0F;
  float q3 = 0.0F;
  float q4 = 0.0F;
  float roll = 0.0F;   // rad
  float pitch = 0.0F;  // rad
  float yaw = 0.0F;    // rad
  float xacc = 0.0F;   // m/s/s
  float yacc = 0.0F;   // m/s/s
  float zacc = 0.0F;   // m/s/s
  float xgyro = 0.0F;  // rad/s
  float ygyro = 0.0F;  // rad/s
  float zgyro = 0.0F;  // rad/s
  float lat = 0.0F;    // deg
  float lon = 0.0F;    // deg
  float alt = 0.0F;    // m
  float std_dev_horz = 0.0F;
  float std_dev_vert = 0.0F;
  float vn = 0.0F;  // m/s
  float ve = 0.0F;  // m/s
  float vd = 0.0F;  // m/s
  // extensions
  std::int32_t lat_int = 0;  // degE7
  std::int32_t lon_int = 0;  // degE7

  static constexpr auto fields() {
    return std::tuple{field("q1", &SimState::q1),
                      field("q2", &SimState::q2),
                      field("q3", &SimState::q3),
                      field("q4", &SimState::q4),
                      field("roll", &SimState::roll),
                      field("pitch", &SimState::pitch),
                      field("yaw", &SimState::yaw),
                      field("xacc", &SimState::xacc),
                      field("yacc", &SimState::yacc),
                      field("zacc", &SimState::zacc),
                      field("xgyro", &SimState::xgyro),
                      field("ygyro", &SimState::ygyro),
                      field("zgyro", &SimState::zgyro),
                      field("lat", &SimState::lat),
                      field("lon", &SimState::lon),
                      field("alt", &SimState::alt),
                      field("std_dev_horz", &SimState::std_dev_horz),
                      field("std_dev_vert", &SimState::std_dev_vert),
                      field("vn", &SimState::vn),
                      field("ve", &SimState::ve),
                      field("vd", &SimState::vd),
                      extension("lat_int", &SimState::lat_int),
                      extension("lon_int", &SimState::lon_int)};
  }
};

// Says where on the globe the local origin lies; needed once indoors.
struct SetGpsGlobalOrigin {
  static constexpr std::uint32_t kId = 48;
  static constexpr std::string_view kName = "SET_GPS_GLOBAL_ORIGIN";

  std::uint8_t target_system = 0;
  std::int32_t latitude = 0;   // degE7
  std::int32_t longitude = 0;  // degE7
  std::int32_t altitude = 0;   // mm
  // extensions
  std::uint64_t time_usec = 0;  // us

  static constexpr auto fields() {
    return std::tuple{field("target_system", &SetGpsGlobalOrigin::target_system),
                      field("latitude", &SetGpsGlobalOrigin::latitude),
                      field("longitude", &SetGpsGlobalOrigin::longitude),
                      field("altitude", &SetGpsGlobalOrigin::altitude),
                      extension("time_usec", &SetGpsGlobalOrigin::time_usec)};
  }
};

// Where on the globe the local origin lies.
struct GpsGlobalOrigin {
  static constexpr std::uint32_t kId = 49;
  static constexpr std::string_view kName = "GPS_GLOBAL_ORIGIN";

  std::int32_t latitude = 0;   // degE7
  std::int32_t longitude = 0;  // degE7
  std::int32_t altitude = 0;   // mm
  // extensions
  std::uint64_t time_usec = 0;  // us

  static constexpr auto fields() {
    return std::tuple{
        field("latitude", &GpsGlobalOrigin::latitude), field("longitude", &GpsGlobalOrigin::longitude),
        field("altitude", &GpsGlobalOrigin::altitude), extension("time_usec", &GpsGlobalOrigin::time_usec)};
  }
};

// Where home is.
struct HomePosition {
  static constexpr std::uint32_t kId = 242;
  static constexpr std::string_view kName = "HOME_POSITION";

  std::int32_t latitude = 0;   // degE7
  std::int32_t longitude = 0;  // degE7
  std::int32_t altitude = 0;   // mm
  float x = 0.0F;              // m
  float y = 0.0F;              // m
  float z = 0.0F;              // m
  std::array<float, 4> q{};
  float approach_x = 0.0F;  // m
  float approach_y = 0.0F;  // m
  float approach_z = 0.0F;  // m
  // extensions
  std::uint64_t time_usec = 0;  // us

  static constexpr auto fields() {
    return std::tuple{field("latitude", &HomePosition::latitude),
                      field("longitude", &HomePosition::longitude),
                      field("altitude", &HomePosition::altitude),
                      field("x", &HomePosition::x),
                      field("y", &HomePosition::y),
                      field("z", &HomePosition::z),
                      field("q", &HomePosition::q),
                      field("approach_x", &HomePosition::approach_x),
                      field("approach_y", &HomePosition::approach_y),
                      field("approach_z", &HomePosition::approach_z),
                      extension("time_usec", &HomePosition::time_usec)};
  }
};

// Sets where home is.
struct SetHomePosition {
  static constexpr std::uint32_t kId = 243;
  static constexpr std::string_view kName = "SET_HOME_POSITION";

  std::uint8_t target_system = 0;
  std::int32_t latitude = 0;   // degE7
  std::int32_t longitude = 0;  // degE7
  std::int32_t altitude = 0;   // mm
  float x = 0.0F;              // m
  float y = 0.0F;              // m
  float z = 0.0F;              // m
  std::array<float, 4> q{};
  float approach_x = 0.0F;  // m
  float approach_y = 0.0F;  // m
  float approach_z = 0.0F;  // m
  // extensions
  std::uint64_t time_usec = 0;  // us

  static constexpr auto fields() {
    return std::tuple{field("target_system", &SetHomePosition::target_system),
                      field("latitude", &SetHomePosition::latitude),
                      field("longitude", &SetHomePosition::longitude),
                      field("altitude", &SetHomePosition::altitude),
                      field("x", &SetHomePosition::x),
                      field("y", &SetHomePosition::y),
                      field("z", &SetHomePosition::z),
                      field("q", &SetHomePosition::q),
                      field("approach_x", &SetHomePosition::approach_x),
                      field("approach_y", &SetHomePosition::approach_y),
                      field("approach_z", &SetHomePosition::approach_z),
                      extension("time_usec", &SetHomePosition::time_usec)};
  }
};

}  // namespace forager::flight::mavlink
