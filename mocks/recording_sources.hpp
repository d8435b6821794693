#pragma once

#include <string>

#include "hal/depth_source.hpp"
#include "hal/pose_source.hpp"
#include "mocks/recording_fields.hpp"

namespace forager::mocks {

// What sees; both borrow the source, which has no name of its own.
//   <pose = ok 12040000000 1.5 0 0.2 0.1 0 0 3 0      stamp, position, yaw, pitch, roll, confidence, resets
//   <frame = ok 12040000000 64 48 ... mm 0a0f...      stamp, columns, rows, fx, fy, cx, cy, min, max, then
//                                                     mm or m, and the pixels as they lie in memory

class RecordingPoseSource final : public hal::PoseSource {
 public:
  RecordingPoseSource(hal::PoseSource& source, std::string name, hal::Recorder& recorder)
      : source_(&source), name_(std::move(name)), recorder_(&recorder) {}

 private:
  hal::Result<std::optional<hal::PoseSample>> do_poll(hal::Instant now) override {
    auto sample = source_->poll(now);
    if (sample && !*sample) return sample;
    return taken(*recorder_, name_, "<pose", {}, std::move(sample), [](const auto& got) {
      const hal::Pose& pose = got->pose;
      hal::Fields fields{hal::field(got->stamp.time_since_epoch())};
      for (const double value :
           {pose.position.x, pose.position.y, pose.position.z, pose.yaw_rad, pose.pitch_rad, pose.roll_rad})
        fields.push_back(hal::field(value));
      fields.push_back(hal::field(static_cast<int>(got->confidence)));
      fields.push_back(hal::field(got->reset_counter));
      return fields;
    });
  }
  hal::PoseSource* source_;
  std::string name_;
  hal::Recorder* recorder_;
};

class RecordingDepthSource final : public hal::DepthSource {
 public:
  RecordingDepthSource(hal::DepthSource& source, std::string name, hal::Recorder& recorder)
      : source_(&source), name_(std::move(name)), recorder_(&recorder) {}

 private:
  static hal::Fields fields_of(const hal::DepthFrame& frame) {
    const hal::DepthCameraModel& camera = frame.camera;
    hal::Fields fields{hal::field(frame.stamp.time_since_epoch()), hal::field(camera.columns),
                       hal::field(camera.rows)};
    for (const double value :
         {camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px, camera.min_m, camera.max_m})
      fields.push_back(hal::field(value));
    fields.emplace_back(std::holds_alternative<std::span<const float>>(frame.pixels) ? "m" : "mm");
    fields.push_back(
        std::visit([](const auto& pixels) { return hal::field(std::as_bytes(pixels)); }, frame.pixels));
    return fields;
  }
  hal::Result<std::optional<hal::DepthFrame>> do_poll(hal::Instant now) override {
    auto frame = source_->poll(now);
    if (frame && !*frame) return frame;
    return taken(*recorder_, name_, "<frame", {}, std::move(frame),
                 [](const auto& got) { return fields_of(*got); });
  }
  hal::DepthSource* source_;
  std::string name_;
  hal::Recorder* recorder_;
};

}  // namespace forager::mocks
