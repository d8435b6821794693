#include "boards/drive_plant.hpp"

#include "hal/random.hpp"
#include "hal/units.hpp"

namespace forager::boards {

std::uint64_t drive_seed(std::uint64_t seed, DriveStream stream) {
  return hal::Random::stream(seed, static_cast<std::uint64_t>(stream)).next();
}

DrivePlantDraw draw_plant(const DriveScene& scene, std::uint64_t seed) {
  hal::Random random = hal::Random::stream(seed, static_cast<std::uint64_t>(DriveStream::plant));
  std::array<double, kDriveRanges> drawn{};
  for (std::size_t i = 0; i < kDriveRanges; ++i)
    drawn[i] = random.uniform(scene.ranges[i].low, scene.ranges[i].high);
  const auto of = [&](DriveRange r) { return drawn[static_cast<std::size_t>(r)]; };

  DrivePlantDraw draw;
  mocks::RollingParameters& v = draw.vehicle;
  v.half_track_m = scene.drive.steer.half_track_m;
  v.mass_kg = of(DriveRange::mass_kg);
  v.max_thrust_n = of(DriveRange::max_thrust_n);
  v.friction = of(DriveRange::friction);
  v.rolling_resistance = of(DriveRange::rolling_resistance);
  v.surface_drag_n_s_m = of(DriveRange::surface_drag_n_s_m);
  v.drag_asymmetry = of(DriveRange::drag_asymmetry);
  v.thrust_offset_m = of(DriveRange::thrust_offset_m);
  v.grade_x = of(DriveRange::grade_x);
  v.grade_y = of(DriveRange::grade_y);
  v.brake_force_n = of(DriveRange::brake_force_n);
  v.servo_lag_s = of(DriveRange::servo_lag_s);
  v.thrust_lag_s = of(DriveRange::thrust_lag_s);
  draw.pose.position_noise_m = of(DriveRange::pose_noise_m);
  draw.pose.angle_noise_rad = hal::deg_to_rad(of(DriveRange::pose_noise_deg));
  draw.pose.dropouts_per_s = of(DriveRange::dropouts_per_s);
  draw.pose.dropout_length = hal::from_seconds(of(DriveRange::dropout_s));
  draw.gyro_noise_rad_s = hal::deg_to_rad(of(DriveRange::gyro_noise_deg_s));
  draw.gyro_bias_rad_s = hal::deg_to_rad(of(DriveRange::gyro_bias_deg_s));
  return draw;
}

}  // namespace forager::boards
