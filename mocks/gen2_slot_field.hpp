#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/random.hpp"
#include "mocks/body.hpp"
#include "mocks/body_track.hpp"
#include "mocks/gen2_field_dwell.hpp"
#include "mocks/gen2_field_flags.hpp"
#include "mocks/gen2_field_link.hpp"
#include "mocks/gen2_field_nearby.hpp"
#include "mocks/gen2_field_power.hpp"
#include "mocks/gen2_slot_parameters.hpp"
#include "mocks/gen2_slot_round.hpp"
#include "mocks/tag_field.hpp"
#include "mocks/world.hpp"

namespace forager::mocks {

// What a field did, for tests and benchmarks.
struct SlotStatistics {
  std::uint64_t dwells = 0;
  std::uint64_t hops = 0;  // within a dwell
  std::uint64_t rounds = 0;
  std::uint64_t draws = 0;         // tags looked at
  std::uint64_t participants = 0;  // tags that heard a Query
  std::uint64_t empty = 0;         // slots
  std::uint64_t collided = 0;
  std::uint64_t single = 0;          // read
  std::uint64_t captured = 0;        // of these, out of a collision
  std::uint64_t lost = 0;            // a single reply that was not understood
  std::uint64_t cut = 0;             // the carrier went off within the slot
  std::uint64_t too_weak = 0;        // read, but below the port's sensitivity: not reported
  std::uint64_t bound_exceeded = 0;  // 0, or the bound of the rates is wrong
  [[nodiscard]] std::uint64_t slots() const { return empty + collided + single + lost + cut; }
};

// The air between a reader on the vehicle and the tags of the world, slot by slot (Gen2 v1.2.0 sec. 6.3.2):
// every command and reply takes its time, tags collide, the reader adapts Q, counts tags into a session and
// leaves a port at the end of a round.
//
// From PD to rounds. PD is the chance that a tag alone in the field is read within T0 of listening, and
// lambda = -ln(1 - PD)/T0 its hazard rate. Listening is the time on the tag's port in which nobody else is
// heard: overhead, Query and empty slots; neither what replies and collisions take nor the dead time after a
// switch, as in the round-level field. A round is offered the listening time L on its port since the one
// before it. A tag with power and the right flag takes part in it to be heard with chance 1 - exp(-lambda L),
// and otherwise in vain with chance 1 - exp(-lambda L (1-s)/s): its reply is lost, where s is the chance that
// a reply of this strength is understood (not taken below 1/4). So s shapes how much time is wasted, and
// lambda alone who is heard. A tag that takes part is offered slots until it is told apart from others; one
// whose reply is lost stays away for the rest of the round. The L of all rounds add up to the time listened,
// and a lone tag is read within T0 with chance PD, whatever the rounds, dwells and ticks; what remains is the
// delay of half a round, lambda times 10 ms.
//
// The cost follows the slots and replies: participants are drawn by thinning under bounds that hold around
// the place they were computed for, and slots one by one from their binomial law. There is no tick; at rest
// the reads do not depend on when advance() is called. The switches skip_* of AirParameters hold here too,
// but for skip_blind_antennas and unchanged_m: a round takes place anyway, and poses are renewed every 5 ms.
//
// Not modelled: Select commands, access, readers that disturb each other, noise taken for a reply, T1 and BLF
// within their tolerances (nominal).
// world (fixed) and body must outlive the field. Once it has been in the densest part of the world it
// allocates in radio_on() only.
class SlotTagField final : public TagField {
 public:
  // Parameters must have passed validate().
  SlotTagField(const World& world, const TrueBody& body, const std::vector<AntennaMounting>& antennas,
               const AirParameters& air, const SlotParameters& slots, std::uint64_t seed);

  // Call advance(now) before: what the old settings would still have heard is lost.
  void radio_on(const RadioSettings& settings, hal::Instant now) override;
  void radio_off(hal::Instant now) override;
  void advance(hal::Instant now, std::vector<AirRead>& out) override;
  [[nodiscard]] const std::string& epc_hex(std::uint32_t tag) const override;

  [[nodiscard]] const SlotStatistics& statistics() const { return statistics_; }

 private:
  enum class Phase : std::uint8_t { carrier, round, slot };
  // Acknowledged; counted with the next command.
  struct Heard {
    std::uint32_t tag;
    TagLink link;
    bool to_b;
    bool reported;
  };

  [[nodiscard]] double seconds(hal::Instant now);
  void step(std::vector<AirRead>& out);
  void raise_carrier();
  void drop_carrier();
  void leave_port(double at_s);
  void begin_round();
  void draw_participants(double listened_s);
  void join(std::uint32_t tag, bool heard);
  void draw_each(double listened_s);
  void draw_thinned(const Audible& audible, double listened_s);
  void look_around(double t_s);
  struct Chances {
    double rate_per_s;  // of being heard
    double understood;  // chance that a reply is
  };
  [[nodiscard]] Chances chances(const NearbyTags::Candidate& candidate);
  void begin_frames(bool b);
  void close_slot(std::vector<AirRead>& out);
  void run_slot();
  void hear_nothing();
  void lose(std::size_t chosen, const TagLink& link);
  [[nodiscard]] bool lasts(double slot_us);
  [[nodiscard]] std::size_t strongest(std::span<const std::uint32_t> replies);
  [[nodiscard]] bool cut_off(double command_s, double slot_s);
  void count_heard();
  void report(std::vector<AirRead>& out);
  [[nodiscard]] const AntennaView& view_at(double t_s);
  [[nodiscard]] double& listened() { return listened_s_[schedule_.dwell().port_index]; }

  const World* world_;
  const TrueBody* body_;
  AirParameters air_;
  SlotParameters slots_;
  AirLink link_;
  SessionFlags flags_;
  NearbyTags nearby_;
  std::optional<hal::Vec3> nearby_at_;
  double silent_until_s_ = 0.0;  // tags that nearby_ left out as silent are so until then
  PoweredTags powered_;
  DwellSchedule schedule_;
  SlotRound round_;
  hal::Random random_;
  SlotStatistics statistics_;
  SlotTimes times_;
  double silence_us_ = 0.0;  // behind a NAK
  mutable std::string epc_text_;

  RadioSettings settings_;
  bool on_ = false;
  std::optional<hal::Instant> epoch_;
  BodyTrack track_;
  AntennaView view_;
  double view_s_ = 0.0;
  std::uint64_t view_dwell_ = 0;
  double max_reach_ = 1.0;

  Phase phase_ = Phase::carrier;
  double next_s_ = 0.0;
  std::uint64_t carrier_ = 0;  // stretches of carrier without a break
  std::uint32_t frequency_khz_ = 0;
  double next_hop_s_ = 0.0;
  double idle_round_s_ = 0.0;
  bool first_round_ = true;            // of this visit
  std::vector<double> listened_s_;     // by port, since its last draw of participants
  double command_us_ = 0.0;            // that opened the slot
  double offered_s_ = 0.0;             // listening time this round was drawn for
  bool asks_b_ = false;                // the frames of this round ask tags with flag B
  std::vector<std::uint32_t> others_;  // target AB: participants with the other flag
  std::optional<Heard> heard_;
  // By tag: twice the number of the last round it takes part in, one more if it is to be heard there.
  std::vector<std::uint64_t> drawn_in_;
  std::vector<std::uint64_t> heard_in_;  // by tag: the last dwell that heard it
};

}  // namespace forager::mocks
