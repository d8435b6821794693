#pragma once

#include <memory>
#include <vector>

#include "flight/drive_loop.hpp"
#include "flight/ground_driver.hpp"

namespace forager::flight {

struct DriveGroundConfig {
  DriveConfig drive;
  double step_m = 0.6;                  // along straight pieces; thesis sec. 6.6.2: 0.425 to 0.75 m
  double corridor_half_width_m = 0.45;  // of the strip along the way
  hal::Duration go_for = std::chrono::milliseconds(100);  // each update() says "go on" for so long
};

// A ground driver out of drive loops, one for each way. Its owner's update() is what keeps the loop's
// dead-man and the mission's command alive. Between two ways the last loop, or at first the actuators' own
// halt(), holds both brakes.
class DriveGround final : public GroundDriver {
 public:
  // Borrows the devices; locks both brakes.
  DriveGround(const DriveGroundConfig& config, const DriveDevices& devices);

  // Null before the first way.
  [[nodiscard]] const DriveLoop* loop() const { return loop_.get(); }
  void halt() noexcept override;

 private:
  hal::Result<> do_begin(const std::vector<hal::Vec3>& way_world, hal::Instant now) override;
  void do_update(hal::Instant now) override;
  [[nodiscard]] const GroundStatus& do_status() const override { return status_; }

  DriveGroundConfig config_;
  DriveDevices devices_;
  std::unique_ptr<DriveLoop> loop_;
  GroundStatus status_;
};

// Places along the way, no farther apart than step_m, every corner among them; without the first. Errors:
// invalid_argument (fewer than two corners, not finite, no length).
[[nodiscard]] hal::Result<std::vector<servo::SteerStep>> steps_along(const std::vector<hal::Vec3>& way_world,
                                                                     double step_m);

}  // namespace forager::flight
