#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>

#include "flight/mavlink/description.hpp"

// Health, battery and landed state. Definitions: MAVLink common.xml and ardupilotmega.xml.
// Members keep the names, order and units of the XML.
namespace forager::flight::mavlink {

// Sensors present, enabled and healthy (bit masks); battery at a glance.
struct SysStatus {
  static constexpr std::uint32_t kId = 1;
  static constexpr std::string_view kName = "SYS_STATUS";

  std::uint32_t onboard_control_sensors_present = 0;  // MAV_SYS_STATUS_SENSOR
  std::uint32_t onboard_control_sensors_enabled = 0;  // MAV_SYS_STATUS_SENSOR
  std::uint32_t onboard_control_sensors_health = 0;   // MAV_SYS_STATUS_SENSOR
  std::uint16_t load = 0;                             // d%
  std::uint16_t voltage_battery = 0;                  // mV
  std::int16_t current_battery = 0;                   // cA
  std::int8_t battery_remaining = 0;                  // %
  std::uint16_t drop_rate_comm = 0;                   // c%
  std::uint16_t errors_comm = 0;
  std::uint16_t errors_count1 = 0;
  std::uint16_t errors_count2 = 0;
  std::uint16_t errors_count3 = 0;
  std::uint16_t errors_count4 = 0;
  // extensions
  std::uint32_t onboard_control_sensors_present_extended = 0;  // MAV_SYS_STATUS_SENSOR_EXTENDED
  std::uint32_t onboard_control_sensors_enabled_extended = 0;  // MAV_SYS_STATUS_SENSOR_EXTENDED
  std::uint32_t onboard_control_sensors_health_extended = 0;   // MAV_SYS_STATUS_SENSOR_EXTENDED

  static constexpr auto fields() {
    return std::tuple{field("onboard_control_sensors_present", &SysStatus::onboard_control_sensors_present),
                      field("onboard_control_sensors_enabled", &SysStatus::onboard_control_sensors_enabled),
                      field("onboard_control_sensors_health", &SysStatus::onboard_control_sensors_health),
                      field("load", &SysStatus::load),
                      field("voltage_battery", &SysStatus::voltage_battery),
                      field("current_battery", &SysStatus::current_battery),
                      field("battery_remaining", &SysStatus::battery_remaining),
                      field("drop_rate_comm", &SysStatus::drop_rate_comm),
                      field("errors_comm", &SysStatus::errors_comm),
                      field("errors_count1", &SysStatus::errors_count1),
                      field("errors_count2", &SysStatus::errors_count2),
                      field("errors_count3", &SysStatus::errors_count3),
                      field("errors_count4", &SysStatus::errors_count4),
                      extension("onboard_control_sensors_present_extended",
                                &SysStatus::onboard_control_sensors_present_extended),
                      extension("onboard_control_sensors_enabled_extended",
                                &SysStatus::onboard_control_sensors_enabled_extended),
                      extension("onboard_control_sensors_health_extended",
                                &SysStatus::onboard_control_sensors_health_extended)};
  }
};

// Speeds, altitude and heading for a display.
struct VfrHud {
  static constexpr std::uint32_t kId = 74;
  static constexpr std::string_view kName = "VFR_HUD";

  float airspeed = 0.0F;       // m/s
  float groundspeed = 0.0F;    // m/s
  std::int16_t heading = 0;    // deg
  std::uint16_t throttle = 0;  // %
  float alt = 0.0F;            // m
  float climb = 0.0F;          // m/s

  static constexpr auto fields() {
    return std::tuple{field("airspeed", &VfrHud::airspeed), field("groundspeed", &VfrHud::groundspeed),
                      field("heading", &VfrHud::heading),   field("throttle", &VfrHud::throttle),
                      field("alt", &VfrHud::alt),           field("climb", &VfrHud::climb)};
  }
};

// One battery; unused cells are 65535, unknown numbers -1.
struct BatteryStatus {
  static constexpr std::uint32_t kId = 147;
  static constexpr std::string_view kName = "BATTERY_STATUS";

  std::uint8_t id = 0;
  std::uint8_t battery_function = 0;         // MAV_BATTERY_FUNCTION
  std::uint8_t type = 0;                     // MAV_BATTERY_TYPE
  std::int16_t temperature = 0;              // cdegC
  std::array<std::uint16_t, 10> voltages{};  // mV
  std::int16_t current_battery = 0;          // cA
  std::int32_t current_consumed = 0;         // mAh
  std::int32_t energy_consumed = 0;          // hJ
  std::int8_t battery_remaining = 0;         // %
  // extensions
  std::int32_t time_remaining = 0;              // s
  std::uint8_t charge_state = 0;                // MAV_BATTERY_CHARGE_STATE
  std::array<std::uint16_t, 4> voltages_ext{};  // mV
  std::uint8_t mode = 0;                        // MAV_BATTERY_MODE
  std::uint32_t fault_bitmask = 0;              // MAV_BATTERY_FAULT

  static constexpr auto fields() {
    return std::tuple{field("id", &BatteryStatus::id),
                      field("battery_function", &BatteryStatus::battery_function),
                      field("type", &BatteryStatus::type),
                      field("temperature", &BatteryStatus::temperature),
                      field("voltages", &BatteryStatus::voltages),
                      field("current_battery", &BatteryStatus::current_battery),
                      field("current_consumed", &BatteryStatus::current_consumed),
                      field("energy_consumed", &BatteryStatus::energy_consumed),
                      field("battery_remaining", &BatteryStatus::battery_remaining),
                      extension("time_remaining", &BatteryStatus::time_remaining),
                      extension("charge_state", &BatteryStatus::charge_state),
                      extension("voltages_ext", &BatteryStatus::voltages_ext),
                      extension("mode", &BatteryStatus::mode),
                      extension("fault_bitmask", &BatteryStatus::fault_bitmask)};
  }
};

// On the ground, in the air, taking off or landing (MAV_LANDED_STATE).
struct ExtendedSysState {
  static constexpr std::uint32_t kId = 245;
  static constexpr std::string_view kName = "EXTENDED_SYS_STATE";

  std::uint8_t vtol_state = 0;    // MAV_VTOL_STATE
  std::uint8_t landed_state = 0;  // MAV_LANDED_STATE

  static constexpr auto fields() {
    return std::tuple{field("vtol_state", &ExtendedSysState::vtol_state),
                      field("landed_state", &ExtendedSysState::landed_state)};
  }
};

// ArduPilot: variances and flags of the estimator.
struct EkfStatusReport {
  static constexpr std::uint32_t kId = 193;
  static constexpr std::string_view kName = "EKF_STATUS_REPORT";

  std::uint16_t flags = 0;  // EKF_STATUS_FLAGS
  float velocity_variance = 0.0F;
  float pos_horiz_variance = 0.0F;
  float pos_vert_variance = 0.0F;
  float compass_variance = 0.0F;
  float terrain_alt_variance = 0.0F;
  // extensions
  float airspeed_variance = 0.0F;

  static constexpr auto fields() {
    return std::tuple{field("flags", &EkfStatusReport::flags),
                      field("velocity_variance", &EkfStatusReport::velocity_variance),
                      field("pos_horiz_variance", &EkfStatusReport::pos_horiz_variance),
                      field("pos_vert_variance", &EkfStatusReport::pos_vert_variance),
                      field("compass_variance", &EkfStatusReport::compass_variance),
                      field("terrain_alt_variance", &EkfStatusReport::terrain_alt_variance),
                      extension("airspeed_variance", &EkfStatusReport::airspeed_variance)};
  }
};

// ArduPilot: what four speed controllers report.
struct EscTelemetry1To4 {
  static constexpr std::uint32_t kId = 11030;
  static constexpr std::string_view kName = "ESC_TELEMETRY_1_TO_4";

  std::array<std::uint8_t, 4> temperature{};    // degC
  std::array<std::uint16_t, 4> voltage{};       // cV
  std::array<std::uint16_t, 4> current{};       // cA
  std::array<std::uint16_t, 4> totalcurrent{};  // mAh
  std::array<std::uint16_t, 4> rpm{};           // rpm
  std::array<std::uint16_t, 4> count{};

  static constexpr auto fields() {
    return std::tuple{field("temperature", &EscTelemetry1To4::temperature),
                      field("voltage", &EscTelemetry1To4::voltage),
                      field("current", &EscTelemetry1To4::current),
                      field("totalcurrent", &EscTelemetry1To4::totalcurrent),
                      field("rpm", &EscTelemetry1To4::rpm),
                      field("count", &EscTelemetry1To4::count)};
  }
};

}  // namespace forager::flight::mavlink
