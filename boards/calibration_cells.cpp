#include "boards/calibration_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "boards/reproduce.hpp"
#include "boards/sim_air.hpp"
#include "hal/units.hpp"
#include "mocks/antenna_pattern.hpp"

namespace forager::boards {
namespace {

// Beyond so many times the 95 % point of what was heard nobody hears anything; saying so tells nothing.
constexpr double kFarShare = 1.4;
// Heard from so many times the median range: no measure for others.
constexpr double kWildShare = 3.0;
// Fewer slices do not tell that a tag is not where it is listed.
constexpr std::size_t kFewestToJudge = 3;

struct Slice {
  std::size_t stop = 0;
  std::vector<double> listen_s;  // by port
};

// Where the vehicle stayed about the same for some slices.
struct Stop {
  hal::Pose pose;
  std::size_t begin = 0;  // slices
  std::size_t end = 0;
  std::size_t cell = 0;  // stops of one cell share their fade
};

class Slicer {
 public:
  Slicer(const Recording& recording, const Scene& scene, const CalibrationSlicing& slicing)
      : recording_(recording), slicing_(slicing), air_(air_of(scene)) {
    for (const reader::ReadPort& port : scene.read_plan.ports) {
      ports_.push_back(port.port);
      bearings_.push_back(port.bearing_rad);
      sensitivity_dbm_.push_back(port.sensitivity_dbm.value_or(scene.read_plan.sensitivity_dbm));
    }
    const double length_s = recording.poses.back().time_s - recording.poses.front().time_s;
    slices_.resize(std::max<std::size_t>(1, static_cast<std::size_t>(length_s / slicing.slice_s)));
  }

  CalibrationCells cut() {
    find_stops();
    share_time();
    mark_seen();
    judge_places();
    find_strength();
    CalibrationCells cells;
    cells.tag_begin.push_back(0);
    for (std::size_t tag = 0; tag < recording_.tags.size(); ++tag) append_tag(cells, tag);
    cells.cell_begin.push_back(cells.bins.size());
    finish(cells);
    return cells;
  }

 private:
  [[nodiscard]] double start_s() const { return recording_.poses.front().time_s; }
  [[nodiscard]] std::size_t slice_at(double time_s) const {
    const double place = (time_s - start_s()) / slicing_.slice_s;
    return place < 0.0 ? slices_.size() : static_cast<std::size_t>(std::min(place, 1e12));
  }
  [[nodiscard]] std::size_t port_place(int port) const {
    return static_cast<std::size_t>(std::find(ports_.begin(), ports_.end(), port) - ports_.begin());
  }

  [[nodiscard]] hal::Pose pose_at(double time_s) const {
    const auto& poses = recording_.poses;
    const auto after = std::lower_bound(poses.begin(), poses.end(), time_s,
                                        [](const auto& p, double t) { return p.time_s < t; });
    if (after == poses.begin()) return poses.front().pose;
    if (after == poses.end()) return poses.back().pose;
    const auto& a = *(after - 1);
    const double share = (time_s - a.time_s) / (after->time_s - a.time_s);
    hal::Pose pose = a.pose;
    pose.position = a.pose.position + share * (after->pose.position - a.pose.position);
    pose.yaw_rad += share * hal::angle_difference(after->pose.yaw_rad, a.pose.yaw_rad);
    return pose;
  }

  void find_stops() {
    std::map<std::array<long, 3>, std::size_t> places;
    for (std::size_t i = 0; i < slices_.size(); ++i) {
      const hal::Pose pose = pose_at(start_s() + (static_cast<double>(i) + 0.5) * slicing_.slice_s);
      if (stops_.empty() || norm(pose.position - stops_.back().pose.position) > slicing_.rest_m ||
          std::abs(hal::angle_difference(pose.yaw_rad, stops_.back().pose.yaw_rad)) > slicing_.rest_rad) {
        // Whoever comes back to a place finds the same fade.
        const auto tile = [&](double metres) { return std::lround(metres / slicing_.fade_length_m); };
        const std::array<long, 3> place{tile(pose.position.x), tile(pose.position.y), tile(pose.position.z)};
        stops_.push_back({pose, i, i, places.emplace(place, places.size()).first->second});
      }
      stops_.back().end = i + 1;
      slices_[i].stop = stops_.size() - 1;
    }
    by_cell_.resize(stops_.size());
    std::iota(by_cell_.begin(), by_cell_.end(), std::size_t{0});
    std::stable_sort(by_cell_.begin(), by_cell_.end(),
                     [&](std::size_t a, std::size_t b) { return stops_[a].cell < stops_[b].cell; });
  }

  // Bursts first, then even shares of what is left.
  void share_time() {
    for (Slice& slice : slices_) slice.listen_s.assign(ports_.size(), 0.0);
    for (std::size_t i = 1; i < recording_.reads.size(); ++i) {
      const auto& a = recording_.reads[i - 1];
      const auto& b = recording_.reads[i];
      const std::size_t slice = slice_at(a.time_s);
      const std::size_t port = port_place(b.port);
      if (a.port != b.port || b.time_s - a.time_s > slicing_.burst_gap_s) continue;
      if (slice < slices_.size() && port < ports_.size())
        slices_[slice].listen_s[port] += b.time_s - a.time_s;
    }
    // Each visit of a port begins with settling, and while one tag answers nobody else is heard.
    const double visit_s =
        air_.patience_median_s * std::exp(0.5 * air_.patience_log_sigma * air_.patience_log_sigma);
    const double listening = visit_s / (visit_s + air_.settle_s);
    for (Slice& slice : slices_) {
      double busy_s = 0.0;
      for (const double listen : slice.listen_s) busy_s += listen;
      const double rest_s = std::max(0.0, slicing_.slice_s - busy_s) / static_cast<double>(ports_.size());
      for (double& listen : slice.listen_s) listen += listening * rest_s;
    }
    for (const Recording::Read& read : recording_.reads) {
      const std::size_t slice = slice_at(read.time_s);
      const std::size_t port = port_place(read.port);
      if (slice >= slices_.size() || port >= ports_.size()) continue;
      double& listen = slices_[slice].listen_s[port];
      listen = std::max(listen - air_.singulation_s, 0.1 * listen);
    }
  }

  void mark_seen() {  // sorted keys of (tag, port, slice) in which something was heard
    for (const Recording::Read& read : recording_.reads) {
      const std::size_t slice = slice_at(read.time_s);
      const std::size_t port = port_place(read.port);
      if (slice >= slices_.size() || port >= ports_.size()) continue;
      ++reads_;
      seen_.push_back((std::uint64_t{read.tag} * ports_.size() + port) * slices_.size() + slice);
    }
    std::sort(seen_.begin(), seen_.end());
    seen_.erase(std::unique(seen_.begin(), seen_.end()), seen_.end());
  }

  // How far tags are heard, and which of them cannot be where they are listed.
  void judge_places() {
    std::vector<double> ranges;
    for (const std::uint64_t key : seen_) ranges.push_back(range_of(key));
    const double reach_m = reach_of(ranges);
    misplaced_.assign(recording_.tags.size(), false);
    for (std::size_t i = 0; i < seen_.size();) {
      const std::size_t tag = seen_[i] / slices_.size() / ports_.size();
      std::size_t slices = 0;
      std::size_t beyond = 0;
      for (; i < seen_.size() && seen_[i] / slices_.size() / ports_.size() == tag; ++i, ++slices)
        if (ranges[i] > reach_m) ++beyond;
      misplaced_[tag] = slices >= kFewestToJudge && 2 * beyond > slices;
    }
    for (std::size_t i = 0; i < seen_.size(); ++i)
      if (!misplaced_[seen_[i] / slices_.size() / ports_.size()] && std::isfinite(ranges[i]))
        heard_m_.push_back(ranges[i]);
    far_m_ = reach_of(heard_m_);
  }

  // What all but a few are heard from; tags far out of line have no say.
  static double reach_of(const std::vector<double>& ranges) {
    std::vector<double> finite;
    for (const double range : ranges)
      if (std::isfinite(range)) finite.push_back(range);
    if (finite.empty()) return std::numeric_limits<double>::infinity();
    const double wild_m = kWildShare * quantile(finite, 0.5);
    std::erase_if(finite, [&](double range) { return range > wild_m; });
    return kFarShare * quantile(finite, 0.95);
  }

  // Strength of replies at 1 m on boresight, by what was heard from near; distance and pattern go twice.
  void find_strength() {
    std::vector<double> at_1m;
    const double near_m = quantile(heard_m_, 0.5);
    for (const Recording::Read& read : recording_.reads) {
      const std::size_t slice = slice_at(read.time_s);
      const std::size_t port = port_place(read.port);
      if (slice >= slices_.size() || port >= ports_.size() || misplaced_[read.tag]) continue;
      if (range_m(read.tag, port, slices_[slice].stop) > near_m) continue;
      at_1m.push_back(read.rssi_dbm - path_db(read.tag, port, slices_[slice].stop));
    }
    if (!at_1m.empty()) at_1m_dbm_ = quantile(at_1m, 0.5);
  }

  // Both ways through distance and pattern.
  [[nodiscard]] double path_db(std::size_t tag, std::size_t port, std::size_t stop) const {
    const hal::Pose& pose = stops_[stop].pose;
    const hal::Vec3 offset = recording_.tags[tag].position - pose.position;
    const double power = air_.pattern.power(hal::rotate_yaw(offset, -pose.yaw_rad - bearings_[port]));
    return 20.0 * std::log10(power) - 40.0 * std::log10(std::max(norm(offset), 0.05));
  }

  [[nodiscard]] double range_of(std::uint64_t key) const {
    const std::size_t slice = key % slices_.size();
    const std::size_t port = key / slices_.size() % ports_.size();
    return range_m(key / slices_.size() / ports_.size(), port, slices_[slice].stop);
  }

  [[nodiscard]] double range_m(std::size_t tag, std::size_t port, std::size_t stop) const {
    const hal::Pose& pose = stops_[stop].pose;
    const hal::Vec3 offset = recording_.tags[tag].position - pose.position;
    const double power = air_.pattern.power(hal::rotate_yaw(offset, -pose.yaw_rad - bearings_[port]));
    if (power <= 0.0) return std::numeric_limits<double>::infinity();
    return norm(offset) / std::pow(power, air_.pattern_exponent);
  }

  void append_tag(CalibrationCells& cells, std::size_t tag) {
    if (misplaced_[tag]) cells.misplaced.push_back(static_cast<std::uint32_t>(tag));
    for (std::size_t port = 0; port < ports_.size() && !misplaced_[tag]; ++port) {
      bool open = false;
      std::size_t cell = 0;
      for (const std::size_t at : by_cell_) {
        const Stop& stop = stops_[at];
        const double range = range_m(tag, port, at);
        if (!(range <= far_m_) ||
            at_1m_dbm_ + path_db(tag, port, at) < sensitivity_dbm_[port] + slicing_.above_sensitivity_db)
          continue;
        if (!open || stop.cell != cell) cells.cell_begin.push_back(cells.bins.size());
        open = true;
        cell = stop.cell;
        cells.bins.push_back(bin_of(tag, port, stop.begin, stop.end, range));
        cells.slices += static_cast<double>(stop.end - stop.begin);
        cells.seen_slices += cells.bins.back().seen;
      }
    }
    cells.tag_begin.push_back(cells.cell_begin.size());
  }

  [[nodiscard]] CalibrationBin bin_of(std::size_t tag, std::size_t port, std::size_t first, std::size_t end,
                                      double range) const {
    CalibrationBin bin;
    bin.range_m = range;
    const std::uint64_t base = (std::uint64_t{tag} * ports_.size() + port) * slices_.size();
    auto seen = std::lower_bound(seen_.begin(), seen_.end(), base + first);
    for (std::size_t slice = first; slice < end; ++slice) {
      const double listen = slices_[slice].listen_s[port];
      if (seen != seen_.end() && *seen == base + slice) {
        ++seen;
        ++bin.seen;
        bin.seen_listen_s += listen;
      } else {
        ++bin.unseen;
        bin.unseen_listen_s += listen;
      }
    }
    if (bin.seen > 0) bin.seen_listen_s /= bin.seen;
    return bin;
  }

  void finish(CalibrationCells& cells) const {
    cells.reads = reads_;
    cells.nearest_m = quantile(heard_m_, 0.05);
    cells.farthest_m = quantile(heard_m_, 0.95);
    for (const Stop& stop : stops_)
      cells.moved_m = std::max(cells.moved_m, norm(stop.pose.position - stops_.front().pose.position));
  }

  const Recording& recording_;
  CalibrationSlicing slicing_;
  mocks::AirParameters air_;
  std::vector<int> ports_;
  std::vector<double> bearings_;
  std::vector<Slice> slices_;
  std::vector<Stop> stops_;
  std::vector<std::size_t> by_cell_;
  std::vector<std::uint64_t> seen_;
  std::vector<double> heard_m_;
  std::vector<bool> misplaced_;
  std::vector<double> sensitivity_dbm_;
  double far_m_ = 0.0;
  double at_1m_dbm_ = std::numeric_limits<double>::infinity();
  std::uint64_t reads_ = 0;
};

}  // namespace

CalibrationCells cells_of(const Recording& recording, const Scene& scene, const CalibrationSlicing& slicing) {
  if (recording.poses.size() < 2 || scene.read_plan.ports.empty()) {
    CalibrationCells none;
    none.cell_begin = {0};
    none.tag_begin.assign(recording.tags.size() + 1, 0);
    return none;
  }
  return Slicer(recording, scene, slicing).cut();
}

}  // namespace forager::boards
