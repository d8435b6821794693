#include "mocks/fake_depth_source.hpp"

#include <utility>

namespace forager::mocks {

void FakeDepthSource::show(const hal::DepthFrame& frame) {
  Image image{frame.stamp, frame.camera, {}};
  std::visit([&image](const auto& pixels) { image.pixels = std::vector(pixels.begin(), pixels.end()); },
             frame.pixels);
  waiting_.push_back(std::move(image));
}

void FakeDepthSource::show_wall(hal::Instant stamp, const hal::DepthCameraModel& camera, float distance_m) {
  const auto count = static_cast<std::size_t>(camera.columns) * static_cast<std::size_t>(camera.rows);
  waiting_.push_back(Image{stamp, camera, std::vector<float>(count, distance_m)});
}

hal::Result<std::optional<hal::DepthFrame>> FakeDepthSource::do_poll(hal::Instant now) {
  if (next_error_) return hal::fail(*std::exchange(next_error_, std::nullopt));
  if (disconnected_)
    return hal::fail(hal::ErrorCode::disconnected, "fake depth source", "poll", "the cable is out");
  bool fresh = false;
  while (!waiting_.empty() && waiting_.front().stamp + latency_ <= now) {
    shown_ = std::move(waiting_.front());
    waiting_.pop_front();
    fresh = true;
  }
  if (!fresh) return std::optional<hal::DepthFrame>{};
  hal::DepthFrame frame{shown_->stamp, shown_->camera, {}};
  std::visit([&frame](const auto& pixels) { frame.pixels = std::span(pixels.data(), pixels.size()); },
             shown_->pixels);
  return std::optional(frame);
}

}  // namespace forager::mocks
