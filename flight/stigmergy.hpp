#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "flight/policy.hpp"
#include "flight/tag_memory.hpp"

namespace forager::flight {

struct StigmergyConfig {
  hal::Duration window = std::chrono::seconds(2);
  double step_m = 1.0;
  std::uint32_t tries = 5;        // windows in a row without a new tag, then land
  std::vector<double> heights_m;  // above the take-off plane, tried in turn; at least one

  // Refinements, all off by default.
  double significance = 0.0;      // k: act only if |V| > k * sqrt(sum of weights)
  bool winner_takes_all = false;  // only the antenna with the most new tags pulls
  bool memory = false;            // places where tags were heard and nobody has been yet pull along
  double memory_half_life_s = 60.0;

  // A heading found blocked is not tried again from the same place, within this sector, for this long (what
  // stood there may have walked away).
  double blocked_sector_rad = 0.35;
  double same_place_m = 0.6;
  hal::Duration blocked_for = std::chrono::seconds(60);
  // Without a new tag: at most so many steps towards where tags were last heard, and so many headings looked
  // along to find one that is free. Then only listening is left.
  std::uint32_t search_steps = 2;
  std::uint32_t search_looks = 10;
};

// Direction of the pull: V = sum of w_i d_i over the antenna bearings d_i, theta = atan2(V_y, V_x) in the
// body frame, (-pi, pi]. length is |V|, total the sum of the weights. (Printed eq. 3.7 takes an arc cosine
// and loses the sign.) Bearings are read, never assumed; rounding of opposite pulls is taken for zero.
struct Pull {
  hal::Vec3 vector_body;  // z = 0
  double length = 0.0;
  double total = 0.0;
  double theta_rad = 0.0;  // 0 if length is 0
};
[[nodiscard]] Pull pull_of(std::span<const reader::PortWeight> weights, bool winner_takes_all = false);

// RFID-SOAN, system specification section 3. Each window's pull gives the new heading:
//
//   window                                       step
//   pull, heading not known to be blocked here   turn to it and go a step (the guard has the last word)
//   pull towards a heading known blocked here    stay facing it; what pulls elsewhere by more turns the pull
//   no pull (balanced, or not significant)       stay, the window's tags stay new
//   nothing new at a blocked heading             look for another direction (below)
//   nothing new, first time                      stay, listen once more
//   nothing new again                            next height if there is one, else look for another direction
//   nothing new in `tries` windows               land
//
// Another direction: the heading nearest to where the last pulls came from that is not known to be blocked
// here; of two equally near ones, the one nearer to the way it came. It looks along such headings one after
// the other without listening (a turn costs less than a window), and listens where a free one has led it.
class Stigmergy final : public Policy {
 public:
  explicit Stigmergy(const StigmergyConfig& config);

  Step begin(const hal::Pose& pose_world) override;
  Step decide(const Observation& seen) override;
  [[nodiscard]] std::string_view name() const override { return "stigmergy"; }

 private:
  struct Blocked {
    hal::Vec3 place_world;
    double heading_rad = 0.0;
    hal::Instant until;
  };

  Step choose(const Observation& seen);
  [[nodiscard]] Step follow(const Observation& seen) const;
  Step search(const Observation& seen);
  [[nodiscard]] std::optional<double> free_heading(const Observation& seen) const;
  [[nodiscard]] bool known_blocked(const Observation& seen, double heading_rad) const;
  void learn(const Observation& seen);
  [[nodiscard]] Step finish(Step step) const;

  StigmergyConfig config_;
  TagMemory memory_;
  std::array<Blocked, 16> blocked_{};
  std::size_t next_blocked_ = 0;
  hal::Vec3 trail_world_;  // way made, older parts fading: the direction it came along
  hal::Vec3 last_position_world_;
  hal::Vec3 recent_pull_world_;  // unit vectors of the pulls, older ones fading
  bool looking_ = false;         // the last step was part of a search
  std::uint32_t searched_ = 0;   // search steps made since the last new tag
  std::uint32_t looks_ = 0;      // headings looked along since the last new tag
  std::size_t height_ = 0;
  std::size_t heights_tried_ = 0;
};

}  // namespace forager::flight
