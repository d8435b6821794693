#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/random.hpp"
#include "mocks/body.hpp"
#include "mocks/gen2_field_dwell.hpp"
#include "mocks/gen2_field_flags.hpp"
#include "mocks/gen2_field_link.hpp"
#include "mocks/gen2_field_parameters.hpp"
#include "mocks/tag_field.hpp"
#include "mocks/world.hpp"

namespace forager::mocks {

// What a field did, for tests and benchmarks.
struct FieldStatistics {
  std::uint64_t dwells = 0;
  std::uint64_t draws = 0;  // tags looked at
  std::uint64_t singulations = 0;
  std::uint64_t too_weak = 0;        // singulated, but below the port's sensitivity: not reported
  std::uint64_t bound_exceeded = 0;  // rates above the bound they were drawn under; 0 or the bound is wrong
};

// The air between a reader on the vehicle and the tags of the world, at the level of inventory rounds. Each
// tag is a Poisson process with the hazard rate of its link while the radio listens to the port and its flag
// fits; a singulation takes its time, during which nobody else is heard.
//
// The process is drawn by thinning: candidates come at the rate of an upper bound that holds for any attitude
// within some decimetres of the place it was computed for, one tag is picked in proportion to its bound, and
// kept with probability true rate / bound. So the cost follows the replies, not tags times ports times ticks,
// there is no tick, and with the body at rest the replies do not depend on how often advance() is called at
// all. Between two calls the body is taken to move evenly; poses are refreshed every 5 ms.
//
// Refinements of the protocol (slots, collisions, a fixed Q) are not modelled: q is ignored.
// world (fixed) and body must outlive the field. Allocates at construction and in radio_on() only.
class SimTagField final : public TagField {
 public:
  // Parameters must have passed validate().
  SimTagField(const World& world, const TrueBody& body, std::vector<AntennaMounting> antennas,
              const AirParameters& air, std::uint64_t seed);

  // Call advance(now) before: what the old settings would still have heard is lost.
  void radio_on(const RadioSettings& settings, hal::Instant now) override;
  void radio_off(hal::Instant now) override;
  void advance(hal::Instant now, std::vector<AirRead>& out) override;
  [[nodiscard]] const std::string& epc_hex(std::uint32_t tag) const override {
    epc_text_.clear();
    world_->tags.append_epc_hex(tag, epc_text_);
    return epc_text_;
  }

  [[nodiscard]] const FieldStatistics& statistics() const { return statistics_; }

 private:
  struct Candidate {
    std::uint32_t tag;
    double bound_per_s;
    double sum_per_s;  // of all bounds up to and with this one
  };

  [[nodiscard]] double seconds(hal::Instant now);
  [[nodiscard]] hal::Pose pose_at(double t_s) const;
  void sample_body(double now_s);
  void begin_dwell();
  void schedule_draw(double from_s);
  void draw(std::vector<AirRead>& out);
  void report(const TagLink& link, std::uint32_t tag, double t_s, std::vector<AirRead>& out);
  void refresh_view(double t_s);
  void refresh_bounds_if_moved(hal::Vec3 position);
  void watch_power(double t_s);

  const World* world_;
  mutable std::string epc_text_;  // what epc_hex() gave last
  const TrueBody* body_;
  AirParameters air_;
  AirLink link_;
  SessionFlags flags_;
  DwellSchedule schedule_;
  hal::Random random_;
  FieldStatistics statistics_;

  RadioSettings settings_;
  bool on_ = false;
  std::optional<hal::Instant> epoch_;
  hal::Pose previous_pose_;
  hal::Pose pose_;
  double previous_s_ = 0.0;
  double now_s_ = 0.0;

  AntennaView view_;
  double view_s_ = 0.0;
  std::uint64_t view_dwell_ = 0;
  std::vector<Candidate> candidates_;
  std::optional<hal::Vec3> bounds_at_;
  double max_reach_ = 1.0;
  double next_draw_s_ = 0.0;
  std::vector<std::uint64_t> heard_in_;  // by tag: the last dwell that heard it
  std::vector<AntennaView> port_views_;
  double power_watched_s_ = 0.0;
  std::optional<hal::Pose> power_watched_at_;
};

}  // namespace forager::mocks
