#pragma once

#include <deque>
#include <optional>
#include <string>

#include "hal/pose_source.hpp"

namespace forager::mocks {

// Poses a test puts in. A sample can be polled `latency` after its stamp.
class FakePoseSource final : public hal::PoseSource {
 public:
  void show(const hal::PoseSample& sample) { waiting_.push_back(sample); }
  void set_latency(hal::Duration latency) { latency_ = latency; }
  void fail_next(hal::Error error) { next_error_ = std::move(error); }
  // The cable is out: every poll() answers disconnected until it is back.
  void disconnect(bool out = true) { disconnected_ = out; }

 private:
  hal::Result<std::optional<hal::PoseSample>> do_poll(hal::Instant now) override;

  std::deque<hal::PoseSample> waiting_;
  hal::Duration latency_{};
  std::optional<hal::Error> next_error_;
  bool disconnected_ = false;
};

}  // namespace forager::mocks
