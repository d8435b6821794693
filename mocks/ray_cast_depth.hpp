#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "hal/depth_source.hpp"
#include "hal/pose.hpp"
#include "hal/random.hpp"
#include "hal/units.hpp"
#include "mocks/body.hpp"
#include "mocks/world.hpp"

namespace forager::mocks {

struct SimDepthOptions {
  int columns = 80;
  int rows = 60;
  double hfov_rad = hal::deg_to_rad(87.0);  // RealSense D435
  double vfov_rad = hal::deg_to_rad(58.0);
  double min_m = 0.15;
  double max_m = 7.0;
  hal::Duration period = std::chrono::milliseconds(100);
  hal::Duration latency{};          // from exposure to delivery, shorter than the period
  hal::Pose mounting;               // camera in the body frame; looks along its +x
  std::optional<double> ceiling_m;  // height of a ceiling, if there is one
  // What nothing within max_m reads as: the maximum (eq. 3.1 of the thesis: "no point" has the maximum
  // possible value), or unknown, as a bare RealSense has it.
  bool far_as_max = false;
  bool metres = false;         // float metres instead of uint16 millimetres
  double noise_per_m = 0.0;    // standard deviation at depth z is noise_per_m z^2; D435 about 0.002
  double speckle_share = 0.0;  // share of pixels unknown, drawn anew for every frame
  double dead_share = 0.0;     // share of pixels unknown for ever
};

enum class DepthFault : std::uint8_t {
  none,
  blind,       // frames come, every pixel unknown
  freeze,      // frames come with new stamps and the old picture
  stall,       // no frames come and no error says so
  disconnect,  // poll() answers disconnected
};

// A depth camera in the simulated warehouse: boxes, the floor z = 0 and perhaps a ceiling, seen through a
// pinhole from the true pose of the body with its full attitude. A frame is rendered only when poll() hands
// one out. Faces of boxes are rasterised: the reciprocal depth of a plane is linear in pixel coordinates,
// which makes it exact at every pixel centre and cheap. Inside a box the lens is covered: all unknown.
// world and body must outlive the camera.
class SimDepthCamera final : public hal::DepthSource {
 public:
  SimDepthCamera(const World& world, const TrueBody& body, const SimDepthOptions& options,
                 std::uint64_t seed);

  void set_fault(DepthFault fault) { fault_ = fault; }
  [[nodiscard]] const hal::DepthCameraModel& model() const { return model_; }

 private:
  struct Camera;  // where the lens is and how it is turned, for one frame
  hal::Result<std::optional<hal::DepthFrame>> do_poll(hal::Instant now) override;
  void expose(hal::Instant now);
  void render(const hal::Pose& body);
  void draw_plane(const Camera& camera, double height_m);
  void draw_box(const Camera& camera, const Box& box);
  void draw_face(const std::array<hal::Vec3, 4>& corners_camera);
  [[nodiscard]] float far_reciprocal() const;
  void disturb();
  void convert();
  [[nodiscard]] hal::DepthFrame frame() const;

  const World* world_;
  const TrueBody* body_;
  SimDepthOptions options_;
  hal::DepthCameraModel model_;
  hal::Random random_;
  DepthFault fault_ = DepthFault::none;
  std::optional<hal::Instant> next_exposure_;
  std::optional<hal::Pose> exposed_;  // waits for its latency to pass
  hal::Instant stamp_{};
  std::vector<float> reciprocal_;  // 1/depth, 0 = nothing seen; row-major
  std::vector<bool> dead_;
  std::vector<std::uint16_t> millimetres_;
  std::vector<float> metres_;
};

}  // namespace forager::mocks
