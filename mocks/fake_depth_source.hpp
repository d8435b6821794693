#pragma once

#include <deque>
#include <optional>
#include <variant>
#include <vector>

#include "hal/depth_source.hpp"

namespace forager::mocks {

// Depth images a test puts in; it keeps copies of the pixels. An image can be polled `latency` after its
// stamp.
class FakeDepthSource final : public hal::DepthSource {
 public:
  void show(const hal::DepthFrame& frame);
  // The same distance in every pixel.
  void show_wall(hal::Instant stamp, const hal::DepthCameraModel& camera, float distance_m);
  void set_latency(hal::Duration latency) { latency_ = latency; }
  void fail_next(hal::Error error) { next_error_ = std::move(error); }
  // The cable is out: every poll() answers disconnected until it is back.
  void disconnect(bool out = true) { disconnected_ = out; }

 private:
  struct Image {
    hal::Instant stamp;
    hal::DepthCameraModel camera;
    std::variant<std::vector<std::uint16_t>, std::vector<float>> pixels;
  };
  hal::Result<std::optional<hal::DepthFrame>> do_poll(hal::Instant now) override;

  std::deque<Image> waiting_;
  std::optional<Image> shown_;
  hal::Duration latency_{};
  std::optional<hal::Error> next_error_;
  bool disconnected_ = false;
};

}  // namespace forager::mocks
