#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hal/pose.hpp"
#include "hal/time.hpp"
#include "mocks/mavlink_peer_wire.hpp"
#include "mocks/vehicle.hpp"

namespace forager::mocks {

// How the emulated EKF3 treats external vision (ArduCopter 4.6, EK3_SRC1_* = 6).
struct SimEstimatorConfig {
  hal::Duration shortest = std::chrono::milliseconds(20);  // samples sooner than this are dropped (50 Hz)
  hal::Duration healthy = std::chrono::milliseconds(300);  // silence after which vision is "not healthy"
  hal::Duration settle = std::chrono::seconds(1);  // of healthy vision before it is a position; assumed
  hal::Duration failsafe = std::chrono::milliseconds(7900);  // silence that ends in LAND; measured in SITL
  double blend_s = 0.12;      // time constant towards the samples; a jump is followed within 0.4 s, measured
  double drift_m_s2 = 0.063;  // growth of the speed error without vision; 0.5 m/s at 7.9 s, measured
};

struct SimAutopilotConfig {
  std::uint8_t system = 1;
  std::uint8_t component = 1;
  bool mavlink1 = false;                               // speak MAVLink 1
  std::uint8_t vehicle_type = 13;                      // MAV_TYPE: 13 hexarotor, 2 quadrotor
  int motors = 6;                                      // outputs 1..motors belong to the mixer
  hal::Duration step = std::chrono::milliseconds(20);  // of physics and scheduler; 10 to 20 ms
  VehicleParameters vehicle;
  hal::Pose start;  // where it stands, world frame
  SimEstimatorConfig estimator;
  peer::CopterMode mode = peer::CopterMode::stabilize;
  bool origin_known = false;  // as if SET_GPS_GLOBAL_ORIGIN had come before

  double loop_rate_hz = 400.0;                              // SCHED_LOOP_RATE
  hal::Duration guided_timeout = std::chrono::seconds(3);   // GUID_TIMEOUT
  bool guided_thrust = false;                               // GUID_OPTIONS bit 3: thrust is thrust
  hal::Duration disarm_delay = std::chrono::seconds(10);    // DISARM_DELAY
  hal::Duration spool_up = std::chrono::milliseconds(500);  // MOT_SPOOL_TIME
  hal::Duration landed_after = std::chrono::seconds(1);     // land detector
  hal::Duration land_disarm = std::chrono::seconds(2);      // touch-down to disarm in LAND, measured
  double land_speed_m_s = 0.5;                              // LAND_SPEED
  double land_fast_above_m = 10.0;                          // LAND_ALT_LOW
  double rtl_altitude_m = 15.0;                             // RTL_ALT
  double arming_battery = 0.2;                              // least fraction to arm (BATT_ARM_MAH)
  std::uint64_t seed = 1;                                   // of faults and drift direction
};

// Per frame (or, for corruption of what it hears, per read) probabilities.
struct FrameFaults {
  double drop = 0.0;
  double duplicate = 0.0;
  double corrupt = 0.0;
};

// What goes wrong. Times count from the first update; everything may be changed while it runs.
struct SimAutopilotFaults {
  struct Window {
    hal::Duration from{};
    hal::Duration to{};
  };
  struct BatteryJump {
    hal::Duration at{};
    double fraction = 0.0;
  };
  struct PilotMode {
    hal::Duration at{};
    peer::CopterMode mode = peer::CopterMode::loiter;
  };
  FrameFaults tx;
  FrameFaults rx;
  std::optional<Window> silence;                // link loss, both ways
  std::optional<hal::Duration> heartbeat_stop;  // the rest goes on
  std::optional<BatteryJump> battery;           // once
  std::optional<PilotMode> pilot;               // once: somebody at the remote control takes over
  std::string refuse_arming;                    // not empty: the pre-arm check fails with this text
  bool ignore_setpoints = false;
  double yaw_drift_rad_s = 0.0;  // of the gyro, left positive
};

}  // namespace forager::mocks
