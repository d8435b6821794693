#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/random.hpp"
#include "mocks/body.hpp"
#include "mocks/body_track.hpp"
#include "mocks/gen2_field_dwell.hpp"
#include "mocks/gen2_field_flags.hpp"
#include "mocks/gen2_field_link.hpp"
#include "mocks/gen2_field_nearby.hpp"
#include "mocks/gen2_field_parameters.hpp"
#include "mocks/gen2_field_power.hpp"
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
  std::uint64_t renewals = 0;        // looks around for tags in range
  std::uint64_t examined = 0;        // tags whose distance was computed in them
  std::uint64_t views = 0;           // antenna poses computed
  std::uint64_t blind_dwells = 0;    // spent without a draw: no tag before the antenna
};

// The air between a reader on the vehicle and the tags of the world, at the level of inventory rounds. Each
// tag is a Poisson process with the hazard rate of its link while the radio listens to the port and its flag
// fits; a singulation takes its time, during which nobody else is heard.
//
// The process is drawn by thinning: candidates come at the rate of an upper bound that holds within some
// decimetres of the place it was computed for, one tag is picked in proportion to its bound, and kept with
// probability true rate / bound. So the cost follows the replies, not tags times ports times ticks, there is
// no tick, and with the body at rest the replies do not depend on how often advance() is called at all.
// Between two calls the body is taken to move evenly; poses are refreshed every 5 ms. What is left out on the
// way (tags out of range, behind, silent, unchanged geometry) has a switch each in AirParameters.
//
// Refinements of the protocol (slots, collisions, a fixed Q) are not modelled: q is ignored.
// world (fixed) and body must outlive the field. Allocates at construction and in radio_on() only, as long as
// fewer than 65536 tags are in range. Memory: about 90 bytes a tag.
class SimTagField final : public TagField {
 public:
  // Parameters must have passed validate().
  SimTagField(const World& world, const TrueBody& body, const std::vector<AntennaMounting>& antennas,
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
  // Where an antenna was when it was last looked at, and what it could hear from there.
  struct Ear {
    bool known = false;
    AntennaView view;
    hal::Pose body;
    double at_s = 0.0;
    Audible audible;
    hal::Pose audible_body;
    std::uint64_t audible_generation = 0;  // of nearby_; 0: none yet
  };

  [[nodiscard]] double seconds(hal::Instant now);
  void begin_dwell();
  void schedule_draw();
  void draw(std::vector<AirRead>& out);
  void report(const TagLink& link, std::uint32_t tag, double t_s, std::vector<AirRead>& out);
  [[nodiscard]] Ear& ear() { return ears_[schedule_.dwell().port_index]; }
  // Brings everything up to the body's pose at t_s; true if what the antenna may hear has changed.
  bool look_around(double t_s);
  void renew_nearby(double t_s, hal::Vec3 position);
  void renew_view(double t_s, const hal::Pose& pose);

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
  BodyTrack track_;

  NearbyTags nearby_;
  std::optional<hal::Vec3> nearby_at_;
  double silent_until_s_ = 0.0;   // tags that nearby_ left out as silent are so until then
  std::size_t silent_draws_ = 0;  // since the last renewal
  double max_reach_ = 1.0;
  std::vector<Ear> ears_;  // by port index
  PoweredTags powered_;
  double free_s_ = 0.0;  // the air is busy until then
  double next_draw_s_ = 0.0;
  double next_look_s_ = 0.0;
  std::vector<std::uint64_t> heard_in_;  // by tag: the last dwell that heard it
};

}  // namespace forager::mocks
