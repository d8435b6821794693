#pragma once

#include <algorithm>

#include "hal/pose.hpp"
#include "hal/units.hpp"

namespace forager::mocks {

// Where the body was between two looks at it: it is taken to have moved evenly.
class BodyTrack {
 public:
  // Forgets the way up to here.
  void start(double now_s, const hal::Pose& pose) {
    previous_s_ = now_s_ = now_s;
    previous_ = pose_ = pose;
  }
  // Not before the last look.
  void look(double now_s, const hal::Pose& pose) {
    if (now_s > now_s_) {
      previous_ = pose_;
      previous_s_ = now_s_;
    }
    pose_ = pose;
    now_s_ = now_s;
  }
  [[nodiscard]] double now_s() const { return now_s_; }
  [[nodiscard]] hal::Pose at(double t_s) const {
    if (t_s >= now_s_ || now_s_ <= previous_s_) return pose_;
    const double share = std::max(t_s - previous_s_, 0.0) / (now_s_ - previous_s_);
    const auto between = [share](double a, double b) { return a + share * (b - a); };
    return {previous_.position + share * (pose_.position - previous_.position),
            previous_.yaw_rad + share * hal::angle_difference(pose_.yaw_rad, previous_.yaw_rad),
            between(previous_.pitch_rad, pose_.pitch_rad), between(previous_.roll_rad, pose_.roll_rad)};
  }

 private:
  hal::Pose previous_;
  hal::Pose pose_;
  double previous_s_ = 0.0;
  double now_s_ = 0.0;
};

}  // namespace forager::mocks
