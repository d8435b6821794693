#include "mocks/gen2_slot_parameters.hpp"

#include <fmt/format.h>

#include <cmath>

#include "mocks/gen2_slot_round.hpp"

namespace forager::mocks {
namespace {

hal::Result<> refuse(std::string detail) {
  return hal::fail(hal::ErrorCode::invalid_argument, "slot-level air", "check parameters", std::move(detail));
}

double opening_us(SlotCommand command, const SlotTimes& s) {
  if (command == SlotCommand::query_rep) return 0.0;
  return (command == SlotCommand::query ? s.query_us : s.query_adjust_us) - s.query_rep_us;
}

}  // namespace

hal::Result<> validate(const SlotParameters& slots, const AirParameters& air) {
  if (auto link = validate(slots.link); !link) return link;
  const struct {
    const char* name;
    double value;
    double low;
    double high;
  } fields[] = {{"first_q", slots.first_q, 0.0, 15.0},
                {"q_step", slots.q_step, 0.05, 1.0},
                {"round_overhead_s", slots.round_overhead_s, 0.0, 1.0},
                {"hop_interval_s", slots.hop_interval_s, 0.0, 1e3},
                {"capture_probability", slots.capture_probability, 0.0, 1.0},
                {"decode_half_dbm", slots.decode_half_dbm, -200.0, 0.0},
                {"decode_scale_db", slots.decode_scale_db, 0.01, 20.0}};
  for (const auto& f : fields)
    if (!(f.value >= f.low && f.value <= f.high))
      return refuse(fmt::format("{} = {} is not within {} to {}", f.name, f.value, f.low, f.high));
  const SlotTimes times = slot_times(slots.link);
  const double least_s =
      air.settle_s + slots.round_overhead_s + 1e-6 * (times.query_us - times.query_rep_us + times.success_us);
  if (air.max_dwell_s < least_s)
    return refuse(fmt::format("max_dwell_s = {} is shorter than the {:.4f} s that one read takes",
                              air.max_dwell_s, least_s));
  if (slots.hop_interval_s > 0.0 && slots.hop_interval_s < least_s)
    return refuse(fmt::format("hop_interval_s = {} is shorter than the {:.4f} s that one read takes",
                              slots.hop_interval_s, least_s));
  return {};
}

double decode_probability(const SlotParameters& slots, double rssi_dbm) {
  return 1.0 / (1.0 + std::exp((slots.decode_half_dbm - rssi_dbm) / slots.decode_scale_db));
}

double idle_round_s(const SlotParameters& slots, int fixed_q) {
  const SlotTimes times = slot_times(slots.link);
  SlotRound round(0);
  round.start(fixed_q >= 0 ? QAlgorithm(fixed_q, 0.0) : QAlgorithm(slots.first_q, slots.q_step));
  double us = 0.0;
  for (; !round.over(); round.heard_nothing()) us += opening_us(round.command(), times) + times.empty_us;
  return slots.round_overhead_s + 1e-6 * us;
}

RoundParameters round_parameters(const SlotParameters& slots, std::uint32_t tags) {
  constexpr int kRounds = 400;
  const SlotTimes times = slot_times(slots.link);
  SlotRound round(tags);
  hal::Random random(1);
  double busy_us = 0.0;
  for (int i = 0; i < kRounds; ++i) {
    round.clear();
    for (std::uint32_t tag = 0; tag < tags; ++tag) round.join(tag);
    round.start({slots.first_q, slots.q_step});
    while (!round.over()) {
      const double opening = opening_us(round.command(), times);
      const std::size_t replies = round.open_slot(random).size();
      if (replies == 0) {
        round.heard_nothing();
      } else if (replies == 1 || random.chance(slots.capture_probability)) {
        busy_us += opening + times.success_us;
        round.heard_one(0);
      } else {
        busy_us += opening + times.collided_us;
        round.heard_collision();
      }
    }
  }
  return {.round_s = idle_round_s(slots),
          .singulation_s = 1e-6 * busy_us / (static_cast<double>(tags) * kRounds)};
}

}  // namespace forager::mocks
