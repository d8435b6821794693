#include "reader/inventory_export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string_view>
#include <vector>

namespace forager::reader {
namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

// x, y, z, yaw; empty unless all of them can be trusted.
std::array<std::string, 4> pose_fields(const InventoryItem& item, std::string_view unknown) {
  const hal::Pose& pose = item.best_pose_world;
  if (!item.pose_known || !is_finite(pose.position) || !std::isfinite(pose.yaw_rad)) {
    const std::string text(unknown);
    return {text, text, text, text};
  }
  return {fmt::format("{}", pose.position.x), fmt::format("{}", pose.position.y),
          fmt::format("{}", pose.position.z), fmt::format("{}", pose.yaw_rad)};
}

}  // namespace

InventorySummary summarize(std::span<const InventoryItem> items) {
  InventorySummary summary;
  if (items.empty()) return summary;
  summary.first_seen = items.front().first_seen;
  summary.last_seen = items.front().last_seen;
  std::vector<std::int16_t> best;
  best.reserve(items.size());
  for (const InventoryItem& item : items) {
    ++summary.items;
    summary.reads += item.count;
    summary.located += item.pose_known ? 1 : 0;
    summary.first_seen = std::min(summary.first_seen, item.first_seen);
    summary.last_seen = std::max(summary.last_seen, item.last_seen);
    best.push_back(item.best_rssi_dbm);
  }
  std::sort(best.begin(), best.end());
  summary.weakest_best_dbm = best.front();
  summary.strongest_dbm = best.back();
  summary.median_best_dbm = best[(best.size() - 1) / 2];
  return summary;
}

std::string exact_seconds(hal::Instant t) {
  const std::int64_t total = t.time_since_epoch().count();
  // Unsigned, because the most negative count has no positive twin.
  const auto magnitude =
      total < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(total) : static_cast<std::uint64_t>(total);
  return fmt::format("{}{}.{:09}", total < 0 ? "-" : "", magnitude / kNanosecondsPerSecond,
                     magnitude % kNanosecondsPerSecond);
}

std::string to_csv(std::span<const InventoryItem> items) {
  std::string out = "epc,reads,first_seen_s,last_seen_s,best_rssi_dbm,best_port,x_m,y_m,z_m,yaw_rad\r\n";
  for (const InventoryItem& item : items) {
    const auto pose = pose_fields(item, "");
    fmt::format_to(std::back_inserter(out), "{},{},{},{},{},{},{},{},{},{}\r\n", item.epc.hex(), item.count,
                   exact_seconds(item.first_seen), exact_seconds(item.last_seen), item.best_rssi_dbm,
                   item.best_port, pose[0], pose[1], pose[2], pose[3]);
  }
  return out;
}

std::string to_json_lines(std::span<const InventoryItem> items) {
  std::string out;
  for (const InventoryItem& item : items) {
    const auto pose = pose_fields(item, "null");
    fmt::format_to(std::back_inserter(out),
                   R"({{"type":"item","epc":"{}","reads":{},"first_seen_s":{},"last_seen_s":{},)"
                   R"("best_rssi_dbm":{},"best_port":{},"x_m":{},"y_m":{},"z_m":{},"yaw_rad":{}}})"
                   "\n",
                   item.epc.hex(), item.count, exact_seconds(item.first_seen), exact_seconds(item.last_seen),
                   item.best_rssi_dbm, item.best_port, pose[0], pose[1], pose[2], pose[3]);
  }
  return out;
}

}  // namespace forager::reader
