#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>

#include "flight/mavlink/description.hpp"

// External localisation and ranges. Definitions: MAVLink common.xml and ardupilotmega.xml.
// Members keep the names, order and units of the XML.
namespace forager::flight::mavlink {

// External localisation, NED and Euler angles; covariance[0] NaN means unknown.
struct VisionPositionEstimate {
  static constexpr std::uint32_t kId = 102;
  static constexpr std::string_view kName = "VISION_POSITION_ESTIMATE";

  std::uint64_t usec = 0;  // us
  float x = 0.0F;          // m
  float y = 0.0F;          // m
  float z = 0.0F;          // m
  float roll = 0.0F;       // rad
  float pitch = 0.0F;      // rad
  float yaw = 0.0F;        // rad
  // extensions
  std::array<float, 21> covariance{};
  std::uint8_t reset_counter = 0;

  static constexpr auto fields() {
    return std::tuple{field("usec", &VisionPositionEstimate::usec),
                      field("x", &VisionPositionEstimate::x),
                      field("y", &VisionPositionEstimate::y),
                      field("z", &VisionPositionEstimate::z),
                      field("roll", &VisionPositionEstimate::roll),
                      field("pitch", &VisionPositionEstimate::pitch),
                      field("yaw", &VisionPositionEstimate::yaw),
                      extension("covariance", &VisionPositionEstimate::covariance),
                      extension("reset_counter", &VisionPositionEstimate::reset_counter)};
  }
};

// External velocity estimate, NED.
struct VisionSpeedEstimate {
  static constexpr std::uint32_t kId = 103;
  static constexpr std::string_view kName = "VISION_SPEED_ESTIMATE";

  std::uint64_t usec = 0;  // us
  float x = 0.0F;          // m/s
  float y = 0.0F;          // m/s
  float z = 0.0F;          // m/s
  // extensions
  std::array<float, 9> covariance{};
  std::uint8_t reset_counter = 0;

  static constexpr auto fields() {
    return std::tuple{field("usec", &VisionSpeedEstimate::usec),
                      field("x", &VisionSpeedEstimate::x),
                      field("y", &VisionSpeedEstimate::y),
                      field("z", &VisionSpeedEstimate::z),
                      extension("covariance", &VisionSpeedEstimate::covariance),
                      extension("reset_counter", &VisionSpeedEstimate::reset_counter)};
  }
};

// Pose in frame_id and velocity in child_frame_id; q is w, x, y, z.
struct Odometry {
  static constexpr std::uint32_t kId = 331;
  static constexpr std::string_view kName = "ODOMETRY";

  std::uint64_t time_usec = 0;      // us
  std::uint8_t frame_id = 0;        // MAV_FRAME
  std::uint8_t child_frame_id = 0;  // MAV_FRAME
  float x = 0.0F;                   // m
  float y = 0.0F;                   // m
  float z = 0.0F;                   // m
  std::array<float, 4> q{};
  float vx = 0.0F;          // m/s
  float vy = 0.0F;          // m/s
  float vz = 0.0F;          // m/s
  float rollspeed = 0.0F;   // rad/s
  float pitchspeed = 0.0F;  // rad/s
  float yawspeed = 0.0F;    // rad/s
  std::array<float, 21> pose_covariance{};
  std::array<float, 21> velocity_covariance{};
  // extensions
  std::uint8_t reset_counter = 0;
  std::uint8_t estimator_type = 0;  // MAV_ESTIMATOR_TYPE
  std::int8_t quality = 0;          // %

  static constexpr auto fields() {
    return std::tuple{field("time_usec", &Odometry::time_usec),
                      field("frame_id", &Odometry::frame_id),
                      field("child_frame_id", &Odometry::child_frame_id),
                      field("x", &Odometry::x),
                      field("y", &Odometry::y),
                      field("z", &Odometry::z),
                      field("q", &Odometry::q),
                      field("vx", &Odometry::vx),
                      field("vy", &Odometry::vy),
                      field("vz", &Odometry::vz),
                      field("rollspeed", &Odometry::rollspeed),
                      field("pitchspeed", &Odometry::pitchspeed),
                      field("yawspeed", &Odometry::yawspeed),
                      field("pose_covariance", &Odometry::pose_covariance),
                      field("velocity_covariance", &Odometry::velocity_covariance),
                      extension("reset_counter", &Odometry::reset_counter),
                      extension("estimator_type", &Odometry::estimator_type),
                      extension("quality", &Odometry::quality)};
  }
};

// Ranges around the vehicle; 65535 unknown, max_distance + 1 nothing there.
struct ObstacleDistance {
  static constexpr std::uint32_t kId = 330;
  static constexpr std::string_view kName = "OBSTACLE_DISTANCE";

  std::uint64_t time_usec = 0;                // us
  std::uint8_t sensor_type = 0;               // MAV_DISTANCE_SENSOR
  std::array<std::uint16_t, 72> distances{};  // cm
  std::uint8_t increment = 0;                 // deg
  std::uint16_t min_distance = 0;             // cm
  std::uint16_t max_distance = 0;             // cm
  // extensions
  float increment_f = 0.0F;   // deg
  float angle_offset = 0.0F;  // deg
  std::uint8_t frame = 0;     // MAV_FRAME

  static constexpr auto fields() {
    return std::tuple{field("time_usec", &ObstacleDistance::time_usec),
                      field("sensor_type", &ObstacleDistance::sensor_type),
                      field("distances", &ObstacleDistance::distances),
                      field("increment", &ObstacleDistance::increment),
                      field("min_distance", &ObstacleDistance::min_distance),
                      field("max_distance", &ObstacleDistance::max_distance),
                      extension("increment_f", &ObstacleDistance::increment_f),
                      extension("angle_offset", &ObstacleDistance::angle_offset),
                      extension("frame", &ObstacleDistance::frame)};
  }
};

// One range finder.
struct DistanceSensor {
  static constexpr std::uint32_t kId = 132;
  static constexpr std::string_view kName = "DISTANCE_SENSOR";

  std::uint32_t time_boot_ms = 0;      // ms
  std::uint16_t min_distance = 0;      // cm
  std::uint16_t max_distance = 0;      // cm
  std::uint16_t current_distance = 0;  // cm
  std::uint8_t type = 0;               // MAV_DISTANCE_SENSOR
  std::uint8_t id = 0;
  std::uint8_t orientation = 0;  // MAV_SENSOR_ORIENTATION
  std::uint8_t covariance = 0;   // cm^2
  // extensions
  float horizontal_fov = 0.0F;  // rad
  float vertical_fov = 0.0F;    // rad
  std::array<float, 4> quaternion{};
  std::uint8_t signal_quality = 0;  // %

  static constexpr auto fields() {
    return std::tuple{field("time_boot_ms", &DistanceSensor::time_boot_ms),
                      field("min_distance", &DistanceSensor::min_distance),
                      field("max_distance", &DistanceSensor::max_distance),
                      field("current_distance", &DistanceSensor::current_distance),
                      field("type", &DistanceSensor::type),
                      field("id", &DistanceSensor::id),
                      field("orientation", &DistanceSensor::orientation),
                      field("covariance", &DistanceSensor::covariance),
                      extension("horizontal_fov", &DistanceSensor::horizontal_fov),
                      extension("vertical_fov", &DistanceSensor::vertical_fov),
                      extension("quaternion", &DistanceSensor::quaternion),
                      extension("signal_quality", &DistanceSensor::signal_quality)};
  }
};

}  // namespace forager::flight::mavlink
