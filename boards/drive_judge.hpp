#pragma once

#include <optional>

#include "boards/drive_rig.hpp"
#include "boards/drive_run.hpp"
#include "boards/drive_scene.hpp"
#include "flight/drive_loop.hpp"

namespace forager::boards {

// Holds a run against the truth of the emulated vehicle, step by step. "Safe" is: no push is demanded, less
// than half the nominal drive force is left, and every brake that works grips with at least half its force;
// or the vehicle stands.
class DriveJudge {
 public:
  DriveJudge(const DriveScene& scene, const flight::DriveCorridor& corridor, DriveResult& result)
      : scene_(&scene), corridor_(&corridor), result_(&result) {}

  void struck(DriveFault fault, double now_s);
  void detected(double now_s);
  void look(DriveRig& rig, double now_s);
  // The final figures, once it stands or its time is over.
  void close(DriveRig& rig, double now_s);
  [[nodiscard]] bool stands() const { return stands_; }

 private:
  void look_around(const mocks::RollingVehicle& vehicle, bool pushes, double now_s);
  [[nodiscard]] bool grips(mocks::RollingVehicle& vehicle) const;

  const DriveScene* scene_;
  const flight::DriveCorridor* corridor_;
  DriveResult* result_;
  std::optional<double> out_since_s_;
  hal::Pose last_;
  bool stands_ = true;
  bool started_ = false;
};

}  // namespace forager::boards
