#include "mocks/replay_sources.hpp"

#include <array>
#include <cstring>

namespace forager::mocks {
namespace {

constexpr std::int64_t kMostPixels = 1 << 24;

// Numbers from fields `first` on; false: one is none.
template <std::size_t kSize>
bool numbers(const hal::Fields& fields, std::size_t first, std::array<double, kSize>& into) {
  for (std::size_t i = 0; i < kSize; ++i) {
    const auto value = hal::number_in(fields[first + i]);
    if (!value) return false;
    into[i] = *value;
  }
  return true;
}

template <class Pixel>
bool fill(const hal::Fields& fields, std::size_t count, std::vector<Pixel>& pixels) {
  const auto bytes = hal::bytes_in(fields.back());
  if (!bytes || bytes->size() != count * sizeof(Pixel)) return false;
  pixels.resize(count);
  if (count > 0) std::memcpy(pixels.data(), bytes->data(), bytes->size());
  return true;
}

}  // namespace

hal::Result<std::optional<hal::PoseSample>> ReplayPoseSource::do_poll(hal::Instant) {
  const auto answer = replay_->arrived(name_, "<pose");
  if (!answer) return std::optional<hal::PoseSample>{};
  if (!*answer) return hal::fail(answer->error());
  const hal::Fields& fields = **answer;
  std::array<double, 8> values{};
  const auto stamp = fields.size() == 9 ? hal::integer_in(fields[0]) : std::nullopt;
  if (!stamp || !numbers(fields, 1, values) || values[6] < 0.0 || values[6] > 3.0 || values[7] < 0.0 ||
      values[7] > 255.0)
    return Replay::broken(name_, "<pose");
  return std::optional(hal::PoseSample{replay_->moved(hal::Instant(hal::Duration(*stamp))),
                                       {{values[0], values[1], values[2]}, values[3], values[4], values[5]},
                                       static_cast<hal::PoseConfidence>(values[6]),
                                       static_cast<std::uint8_t>(values[7])});
}

hal::Result<std::optional<hal::DepthFrame>> ReplayDepthSource::do_poll(hal::Instant) {
  const auto answer = replay_->arrived(name_, "<frame");
  if (!answer) return std::optional<hal::DepthFrame>{};
  if (!*answer) return hal::fail(answer->error());
  const hal::Fields& fields = **answer;
  std::array<double, 6> values{};
  const auto whole = [&](std::size_t i) {
    return fields.size() == 11 ? hal::integer_in(fields[i]) : std::nullopt;
  };
  const auto stamp = whole(0);
  const auto columns = whole(1);
  const auto rows = whole(2);
  if (!stamp || !columns || !rows || *columns < 0 || *rows < 0 || *columns > kMostPixels ||
      *rows > kMostPixels || *columns * *rows > kMostPixels || !numbers(fields, 3, values))
    return Replay::broken(name_, "<frame");
  const auto count = static_cast<std::size_t>(*columns * *rows);
  const bool metres = fields[9] == "m";
  if (!(metres ? fill(fields, count, metres_) : fields[9] == "mm" && fill(fields, count, millimetres_)))
    return Replay::broken(name_, "<frame");
  hal::DepthFrame frame;
  frame.stamp = replay_->moved(hal::Instant(hal::Duration(*stamp)));
  frame.camera = {static_cast<int>(*columns),
                  static_cast<int>(*rows),
                  values[0],
                  values[1],
                  values[2],
                  values[3],
                  values[4],
                  values[5]};
  if (metres)
    frame.pixels = std::span<const float>(metres_);
  else
    frame.pixels = std::span<const std::uint16_t>(millimetres_);
  return std::optional(frame);
}

}  // namespace forager::mocks
