#include "boards/calibration_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <unordered_map>

#include "boards/csv_table.hpp"

namespace forager::boards {
namespace {

constexpr std::size_t kMostBytes = 1U << 30U;
constexpr double kMostSeconds = 1e9;
constexpr double kMostMetres = 1e7;
constexpr double kMostRadians = 1e3;

hal::Result<std::string> epc_of(const CsvTable& table, std::size_t row, std::size_t column) {
  std::string epc(table.field(row, column));
  bool hexadecimal = epc.size() % 2 == 0 && epc.size() <= 128;
  for (char& c : epc) {
    if (c >= 'A' && c <= 'F') c = static_cast<char>(c - 'A' + 'a');
    hexadecimal = hexadecimal && ((c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'));
  }
  if (!hexadecimal) return hal::fail(table.error(row, column, "is not hexadecimal digits in pairs"));
  return epc;
}

using TagIndex = std::unordered_map<std::string, std::uint32_t>;

hal::Result<> read_tags(std::string_view text, const std::string& name, Recording& out, TagIndex& index) {
  static constexpr std::array<std::string_view, 4> kColumns{"epc", "x", "y", "z"};
  const auto table = CsvTable::parse(text, name, kColumns);
  if (!table) return hal::fail(table.error());
  for (std::size_t row = 0; row < table->rows(); ++row) {
    auto epc = epc_of(*table, row, 0);
    if (!epc) return hal::fail(std::move(epc).error());
    std::array<double, 3> at{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto value = table->number(row, i + 1, -kMostMetres, kMostMetres);
      if (!value) return hal::fail(value.error());
      at[i] = *value;
    }
    if (!index.emplace(*epc, static_cast<std::uint32_t>(out.tags.size())).second)
      return hal::fail(table->error(row, 0, "stands twice"));
    out.tags.push_back({std::move(*epc), {at[0], at[1], at[2]}});
  }
  return {};
}

hal::Result<> read_poses(std::string_view text, const std::string& name, Recording& out) {
  static constexpr std::array<std::string_view, 5> kColumns{"time_s", "x", "y", "z", "yaw"};
  const auto table = CsvTable::parse(text, name, kColumns);
  if (!table) return hal::fail(table.error());
  for (std::size_t row = 0; row < table->rows(); ++row) {
    std::array<double, 5> values{};
    for (std::size_t i = 0; i < 5; ++i) {
      const double limit = i == 0 ? kMostSeconds : i == 4 ? kMostRadians : kMostMetres;
      const auto value = table->number(row, i, -limit, limit);
      if (!value) return hal::fail(value.error());
      values[i] = *value;
    }
    if (!out.poses.empty() && values[0] <= out.poses.back().time_s)
      return hal::fail(table->error(row, 0, "is not after the line before"));
    out.poses.push_back({values[0], {{values[1], values[2], values[3]}, values[4], 0.0, 0.0}});
  }
  return {};
}

hal::Result<> read_reads(std::string_view text, const std::string& name, const TagIndex& index,
                         Recording& out) {
  static constexpr std::array<std::string_view, 4> kColumns{"time_s", "epc", "port", "rssi"};
  const auto table = CsvTable::parse(text, name, kColumns);
  if (!table) return hal::fail(table.error());
  for (std::size_t row = 0; row < table->rows(); ++row) {
    const auto time = table->number(row, 0, -kMostSeconds, kMostSeconds);
    if (!time) return hal::fail(time.error());
    auto epc = epc_of(*table, row, 1);
    if (!epc) return hal::fail(std::move(epc).error());
    const auto port = table->whole(row, 2, 1, 32);
    if (!port) return hal::fail(port.error());
    const auto rssi = table->number(row, 3, -200.0, 50.0);
    if (!rssi) return hal::fail(rssi.error());
    const auto tag = index.find(*epc);
    if (tag == index.end())
      ++out.strangers;
    else
      out.reads.push_back({*time, tag->second, static_cast<int>(*port), *rssi});
  }
  std::stable_sort(out.reads.begin(), out.reads.end(),
                   [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
  return {};
}

hal::Result<Recording> parse_named(std::array<std::string_view, 3> texts,
                                   const std::array<std::string, 3>& names) {
  Recording recording;
  TagIndex index;
  FORAGER_TRY(read_tags(texts[2], names[2], recording, index));
  FORAGER_TRY(read_poses(texts[1], names[1], recording));
  FORAGER_TRY(read_reads(texts[0], names[0], index, recording));
  return recording;
}

}  // namespace

hal::Result<Recording> parse_recording(std::string_view reads, std::string_view poses,
                                       std::string_view tags) {
  return parse_named({reads, poses, tags}, {"reads", "poses", "tags"});
}

hal::Result<Recording> load_recording(const std::string& reads, const std::string& poses,
                                      const std::string& tags) {
  const std::array<std::string, 3> names{reads, poses, tags};
  std::array<std::string, 3> texts;
  for (std::size_t i = 0; i < 3; ++i) {
    auto text = read_text_file(names[i], kMostBytes);
    if (!text) return hal::fail(std::move(text).error());
    texts[i] = std::move(*text);
  }
  return parse_named({texts[0], texts[1], texts[2]}, names);
}

std::string reads_csv(const Recording& recording) {
  std::string out = "time_s,epc,port,rssi\n";
  for (const Recording::Read& read : recording.reads)
    fmt::format_to(std::back_inserter(out), "{:.6f},{},{},{}\n", read.time_s, recording.tags[read.tag].epc,
                   read.port, read.rssi_dbm);
  return out;
}

std::string poses_csv(const Recording& recording) {
  std::string out = "time_s,x,y,z,yaw\n";
  for (const Recording::PoseAt& p : recording.poses)
    fmt::format_to(std::back_inserter(out), "{:.6f},{:.4f},{:.4f},{:.4f},{:.5f}\n", p.time_s,
                   p.pose.position.x, p.pose.position.y, p.pose.position.z, p.pose.yaw_rad);
  return out;
}

std::string tags_csv(const Recording& recording) {
  std::string out = "epc,x,y,z\n";
  for (const Recording::Tag& tag : recording.tags)
    fmt::format_to(std::back_inserter(out), "{},{:.4f},{:.4f},{:.4f}\n", tag.epc, tag.position.x,
                   tag.position.y, tag.position.z);
  return out;
}

}  // namespace forager::boards
