#pragma once

#include "hal/error.hpp"
#include "mocks/gen2_field_parameters.hpp"
#include "mocks/gen2_timing.hpp"

namespace forager::mocks {

// What the slot-level air needs beyond AirParameters.
struct SlotParameters {
  LinkProfile link;
  // Q algorithm of annex D, started anew in each round: the first Q, and the step C. A Q fixed in the
  // reader's settings overrules both.
  double first_q = 4.0;
  double q_step = 0.3;
  // Carrier on, between the last slot of a round and the Query of the next: the reader's own work. A captured
  // trace of an Impinj reader shows about 10 ms.
  double round_overhead_s = 0.010;
  // A visit to a port that lasts longer hops to another channel after this time; 0: only between visits. The
  // carrier is off for AirParameters::settle_s, and S0 flags are lost.
  double hop_interval_s = 0.0;
  // Chance that the strongest tag of a collision is understood.
  double capture_probability = 0.0;
  // RSSI at which half of the EPC replies are understood, and the scale of the logistic curve around it.
  double decode_half_dbm = -84.0;
  double decode_scale_db = 1.0;
  // After a bad EPC the reader sends NAK, and the tag stays uncounted; false: it goes on, and the tag turns
  // its flag without having been read.
  bool nak_bad_replies = true;
  bool operator==(const SlotParameters&) const = default;
};

// Errors: invalid_argument naming the field, its value and what is allowed; those of the link; a visit too
// short for a single slot.
[[nodiscard]] hal::Result<> validate(const SlotParameters& slots, const AirParameters& air);

// Chance that a reader understands a tag's EPC reply of this strength.
[[nodiscard]] double decode_probability(const SlotParameters& slots, double rssi_dbm);

// Duration of a round that nobody answers, overhead included. fixed_q: 0 to 15, or -1 for the algorithm.
[[nodiscard]] double idle_round_s(const SlotParameters& slots, int fixed_q = -1);

// What the round-level field (AirParameters) needs to know of a link: how long a round without replies is,
// and how much longer each read makes it, with its share of the collisions when a round holds `tags`.
struct RoundParameters {
  double round_s = 0.0;
  double singulation_s = 0.0;
};
// Runs 400 rounds of the slot-level model with a fixed seed.
[[nodiscard]] RoundParameters round_parameters(const SlotParameters& slots, std::uint32_t tags = 16);

}  // namespace forager::mocks
