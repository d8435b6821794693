#pragma once

#include <cstdint>

#include "hal/journal.hpp"
#include "hal/random.hpp"
#include "hal/time.hpp"
#include "hal/units.hpp"
#include "mocks/body.hpp"
#include "mocks/world.hpp"

namespace forager::mocks {

// What the aerial vehicle can do. "Setting" marks what the flight controller is set to rather than physics.
struct VehicleParameters {
  double max_speed_m_s = 1.0;  // horizontal; setting (WPNAV_SPEED), ch. 4 of the thesis flies at 1 m/s
  double max_acceleration_m_s2 = 1.0;           // horizontal; setting (WPNAV_ACCEL); 5.8 degrees of tilt
  double max_climb_m_s = 1.0;                   // setting (WPNAV_SPEED_UP)
  double max_descent_m_s = 1.0;                 // setting (WPNAV_SPEED_DN)
  double max_vertical_acceleration_m_s2 = 1.0;  // setting (WPNAV_ACCEL_Z, ArduCopter's default)
  double max_yaw_rate_rad_s = hal::deg_to_rad(60.0);  // setting (ATC_SLEW_YAW, ArduCopter's default)
  double max_yaw_acceleration_rad_s2 =
      hal::deg_to_rad(270.0);      // setting (ATC_ACCEL_Y_MAX, ArduCopter's default)
  double position_gain_1_s = 1.0;  // setting (POSXY_P, POSZ_P: ArduCopter's default)
  double yaw_gain_1_s = 4.5;       // setting (ATC_ANG_YAW_P, ArduCopter's default)
  double velocity_lag_s = 0.2;     // velocity loop; an assumption, fast enough for critical damping
  double attitude_lag_s = 0.06;    // tilt follows the demand; an assumption for a 600 mm hexacopter
  double drag_1_s = 0.15;          // linear air drag per mass; an assumption, 0 switches it off
  double wind_gust_m_s = 0.0;      // standard deviation of the air's horizontal speed
  double wind_time_s = 3.0;        // how long a gust lasts (Ornstein-Uhlenbeck)
  double radius_m = 0.4;           // hull for collisions: 550 mm frame and propellers; an assumption
  double half_height_m = 0.2;
  double floor_z_m = 0.0;         // height of the body origin when it stands
  double hard_landing_m_s = 2.0;  // a touch-down faster than this is a crash
  double endurance_s = 1500.0;    // hover time of a full battery: the laboratory's hexacopter, about 25 min
  double capacity_ah = 10.0;      // 4S pack; an assumption, only the reported current depends on it
  double full_v = 16.8;           // 4S LiPo, 4.2 V a cell
  double empty_v = 14.0;          // 3.5 V a cell under no load
  double resistance_ohm = 0.02;   // pack and leads; an assumption
  double idle_share = 0.06;       // current on the ground, as a share of hover
  double climb_share_s_m = 0.25;  // extra share of hover current per m/s of climb; an assumption
  std::uint64_t seed = 1;         // of the wind
};

// What the flight controller asks of the body. World frame.
struct VehicleCommand {
  enum class Follow : std::uint8_t { velocity, position };
  bool motors = false;  // off in the air: it falls
  Follow horizontal = Follow::velocity;
  Follow vertical = Follow::velocity;
  hal::Vec3 position_world;
  hal::Vec3 velocity_world_m_s;  // the demand, or what is added to the way to the position
  bool yaw_by_rate = true;
  double yaw_rad = 0.0;
  double yaw_rate_rad_s = 0.0;
};

// Multirotor as a point mass with heading: square-root position control (brakes in time for the limits, ends
// exponentially, no overshoot), first-order velocity and attitude loops, tilt from acceleration, drag, gusts,
// ground, battery, and contact with the boxes of a world. Deterministic for equal commands and steps; steps
// of 5 to 50 ms.
class Vehicle : public TrueBody {
 public:
  explicit Vehicle(const VehicleParameters& parameters, hal::Pose start = {});

  // The world it can hit and where a crash is written; either may be null. Both must outlive the vehicle.
  void attach(const World* world, hal::Journal* journal);
  void command(const VehicleCommand& command) { command_ = command; }
  // Stands there, level and still; for a vehicle that got there on its wheels.
  void stand_at(hal::Pose pose);
  // Speed limits may change in flight (DO_CHANGE_SPEED), physics may not.
  void limit_speed(double horizontal_m_s) { parameters_.max_speed_m_s = horizontal_m_s; }
  void limit_climb(double up_m_s, double down_m_s) {
    parameters_.max_climb_m_s = up_m_s;
    parameters_.max_descent_m_s = down_m_s;
  }
  // One step of length dt that ends at `now` (which only stamps the journal).
  void update(hal::Duration dt, hal::Instant now);

  [[nodiscard]] const BodyState& state() const override { return state_; }
  [[nodiscard]] const VehicleParameters& parameters() const { return parameters_; }
  [[nodiscard]] hal::Vec3 acceleration_world_m_s2() const { return acceleration_; }
  [[nodiscard]] double battery_fraction() const { return battery_fraction_; }
  [[nodiscard]] double battery_v() const;
  [[nodiscard]] double battery_a() const { return battery_a_; }
  void set_battery_fraction(double fraction) { battery_fraction_ = fraction; }
  // Contacts with boxes so far (one for each approach), and touch-downs harder than the limit.
  [[nodiscard]] std::uint32_t collisions() const { return collisions_; }
  [[nodiscard]] std::uint32_t hard_landings() const { return hard_landings_; }

 private:
  void set_step(double dt_s);
  [[nodiscard]] hal::Vec3 velocity_demand(hal::Vec3& slope) const;
  void move(double dt_s);
  void fall(double dt_s);
  void turn(double dt_s);
  void tilt(hal::Vec3 thrust_m_s2);
  void blow();
  void touch_floor(hal::Instant now);
  void touch_boxes(hal::Vec3 before, hal::Instant now);
  [[nodiscard]] double clearance(hal::Vec3 at) const;
  void drain(double dt_s);
  void crash(hal::Instant now, const char* what, double speed_m_s);

  VehicleParameters parameters_;
  VehicleCommand command_;
  BodyState state_;
  hal::Random wind_random_;
  hal::Vec3 acceleration_;  // of the last step
  hal::Vec3 tilt_m_s2_;     // horizontal and vertical specific thrust, without gravity
  hal::Vec3 wind_m_s_;
  hal::Vec3 wind_felt_m_s2_;  // what the controller's integrator has learnt of the wind
  double step_s_ = 0.0;       // the step the factors below belong to
  double attitude_blend_ = 1.0;
  double wind_keep_ = 0.0;
  double felt_blend_ = 0.0;
  double battery_fraction_ = 1.0;
  double battery_a_ = 0.0;
  const World* world_ = nullptr;
  hal::Journal* journal_ = nullptr;
  double free_way_m_ = 0.0;  // no box can be touched before this much way is made
  bool touching_ = false;
  std::uint32_t collisions_ = 0;
  std::uint32_t hard_landings_ = 0;
};

}  // namespace forager::mocks
