#include "mocks/warehouse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace forager::mocks {
namespace {

hal::Result<> check_row(hal::Vec3 start, hal::Vec3 end, double depth_m, double height_m) {
  const auto refuse = [](std::string detail, std::string mend) {
    return hal::fail(hal::ErrorCode::invalid_argument, "warehouse", "place shelf", std::move(detail),
                     std::move(mend));
  };
  if (!is_finite(start) || !is_finite(end) || (start.x == end.x) == (start.y == end.y))
    return refuse(
        fmt::format("({}, {}) to ({}, {}) does not run along x or y", start.x, start.y, end.x, end.y),
        "boxes are aligned with the axes");
  if (!(depth_m > 0.0) || !(height_m > 0.0))
    return refuse(fmt::format("depth {} m and height {} m must be positive", depth_m, height_m), {});
  return {};
}

// The part of low..high inside the clip, or the nearest edge of the clip if they do not meet.
std::pair<double, double> overlap(double low, double high, double clip_low, double clip_high) {
  return {std::clamp(low, clip_low, clip_high), std::clamp(high, clip_low, clip_high)};
}

}  // namespace

std::string EpcSequence::next() {
  std::string text;
  append_hex(text, next96());
  return text;
}

Epc96 EpcSequence::next96() {
  // 8 header | 3 filter | 3 partition | 24 company | 20 item | 38 serial
  const std::uint64_t serial = serial_++ & 0x3FFFFFFFFFULL;
  const std::uint64_t head = (0x30ULL << 6) | (1ULL << 3) | 5ULL;  // 14 bits
  const std::uint64_t high =
      (head << 50) | (std::uint64_t{company_} << 26) | (std::uint64_t{item_} << 6) | (serial >> 32);
  Epc96 epc{};
  for (unsigned i = 0; i < 8; ++i) epc[i] = static_cast<std::uint8_t>(high >> (56U - 8U * i));
  for (unsigned i = 0; i < 4; ++i) epc[8 + i] = static_cast<std::uint8_t>(serial >> (24U - 8U * i));
  return epc;
}

hal::Result<Box> shelf_row(hal::Vec3 start, hal::Vec3 end, double depth_m, double height_m) {
  FORAGER_TRY(check_row(start, end, depth_m, height_m));
  Box box{{std::min(start.x, end.x), std::min(start.y, end.y), 0.0},
          {std::max(start.x, end.x), std::max(start.y, end.y), height_m}};
  double& low = start.x == end.x ? box.min.x : box.min.y;
  double& high = start.x == end.x ? box.max.x : box.max.y;
  low -= 0.5 * depth_m;
  high += 0.5 * depth_m;
  return box;
}

hal::Result<Box> shelf_with_face(hal::Vec3 start, hal::Vec3 end, double depth_m, double height_m) {
  const double half = 0.5 * depth_m;
  hal::Vec3 shift;
  if (start.x == end.x)
    shift.x = end.y > start.y ? -half : half;
  else
    shift.y = end.x > start.x ? half : -half;
  return shelf_row(start + shift, end + shift, std::abs(depth_m), height_m);
}

void add_group(World& world, const BoxGroup& group, EpcSequence& epcs, hal::Random& random) {
  hal::Vec3 low = group.centre - hal::Vec3{group.half_width_m, group.half_width_m, 0.0};
  hal::Vec3 high = group.centre + hal::Vec3{group.half_width_m, group.half_width_m, group.height_m};
  if (group.within) {
    std::tie(low.x, high.x) = overlap(low.x, high.x, group.within->min.x, group.within->max.x);
    std::tie(low.y, high.y) = overlap(low.y, high.y, group.within->min.y, group.within->max.y);
    std::tie(low.z, high.z) = overlap(low.z, high.z, group.within->min.z, group.within->max.z);
  }
  for (int i = 0; i < group.tags; ++i) {
    // One draw per statement: the order of evaluation of arguments is not fixed.
    const double x = random.uniform(low.x, high.x);
    const double y = random.uniform(low.y, high.y);
    const double z = random.uniform(low.z, high.z);
    world.tags.add(epcs.next96(), {x, y, z}, group.wanted);
  }
}

void add_groups(World& world, const BoxGroup& first, hal::Vec3 pitch, int count, EpcSequence& epcs,
                hal::Random& random) {
  for (int i = 0; i < count; ++i) {
    BoxGroup group = first;
    group.centre = first.centre + static_cast<double>(i) * pitch;
    add_group(world, group, epcs, random);
  }
}

}  // namespace forager::mocks
