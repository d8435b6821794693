#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "boards/accuracy_row.hpp"
#include "hal/random.hpp"
#include "hal/units.hpp"
#include "mocks/gen2_field.hpp"
#include "mocks/gen2_slot_field.hpp"
#include "mocks/gen2_slot_tag.hpp"
#include "mocks/warehouse.hpp"

namespace forager::boards {
namespace {

constexpr double kCuts[] = {0.0, 1e-12, 1e-9, 1e-6};
constexpr double kListen_s = 20.0;
constexpr double kForget_s = 60.0;  // no S2 flag lasts longer without power
constexpr double kR0_m = 2.5;
constexpr double kBeam_rad = 70.0 * std::numbers::pi / 180.0;

struct StandingBody final : mocks::TrueBody {
  StandingBody() { body.pose.position = {0.0, 0.0, 1.2}; }
  mocks::BodyState body;
  [[nodiscard]] const mocks::BodyState& state() const override { return body; }
};

// Expected answers of a tag within T0 = 1 s, by the formulas as they are printed, in extended precision.
long double answers_in_1s(hal::Vec3 offset) {
  const long double x = offset.x;
  const long double y = offset.y;
  const long double z = offset.z;
  const long double azimuth = std::atan2(y, x);
  const long double elevation = std::atan2(z, std::hypot(x, y));
  if (x <= 0.0L || std::abs(azimuth) >= kBeam_rad || std::abs(elevation) >= kBeam_rad) return 0.0L;
  const long double half_pi = std::numbers::pi_v<long double> / 2.0L;
  const long double beam =
      std::cos(half_pi * azimuth / kBeam_rad) * std::cos(half_pi * elevation / kBeam_rad);
  const long double u = std::hypot(x, y, z) / (kR0_m * beam);
  const long double tail = std::exp(-u * std::log(3.0L));
  return std::log1p(2.0L * tail / (1.0L - tail));
}

// Many tags around a reader that stands, no fade, no spread, no power-up limit: their expected number is a
// sum.
struct Hall {
  explicit Hall(std::uint64_t seed) {
    hal::Random random(seed);
    mocks::EpcSequence epcs(1, 1);
    for (int i = 0; i < 20'000; ++i) {
      const hal::Vec3 place{random.uniform(-50.0, 50.0), random.uniform(-50.0, 50.0),
                            random.uniform(0.2, 2.0)};
      // Nearer than this the model lets every tag answer alike.
      if (norm(place - body.body.pose.position) < 0.3) continue;
      world.tags.push_back({epcs.next(), place, true});
      expected +=
          -std::expm1(-static_cast<long double>(kListen_s) * answers_in_1s(place - body.body.pose.position));
    }
    air.r0_m = kR0_m;
    air.t0_s = 1.0;
    air.spread_db = 0.0;
    air.rician_k_db = mocks::FrozenFade::kNoFade_db;
    air.power_up_limit = std::numeric_limits<double>::infinity();
    air.settle_s = 0.0;
    air.singulation_s = 0.0;
    slots.link = {.tari_us = 6.25, .pie = 1.5, .blf_khz = 640.0, .m = 1};
    slots.round_overhead_s = 0.0;
    slots.decode_half_dbm = -200.0;
    radio.session = 2;
    radio.ports = {{1, 30.0, -200.0}};
  }
  mocks::World world;
  StandingBody body;
  mocks::AirParameters air;
  mocks::SlotParameters slots;
  mocks::RadioSettings radio;
  long double expected = 0.0L;
};

struct Listener {
  std::shared_ptr<Hall> hall;
  std::unique_ptr<mocks::TagField> field;
  double now_s = 0.0;
  std::vector<mocks::AirRead> reads;

  // S2 counts each tag once, so reads are tags.
  std::size_t listen() {
    const auto at = [this](double later_s) { return hal::Instant{} + hal::from_seconds(now_s + later_s); };
    reads.clear();
    field->radio_on(hall->radio, at(0.0));
    field->advance(at(kListen_s), reads);
    field->radio_off(at(kListen_s));
    now_s += kListen_s + kForget_s;
    return reads.size();
  }
};

AccuracyRow inventory_row(const std::shared_ptr<Hall>& hall, bool slot, double cut, bool grid, int runs,
                          std::uint64_t seed) {
  mocks::AirParameters air = hall->air;
  air.hazard_cut = cut;
  air.skip_by_grid = grid;
  const auto listener = std::make_shared<Listener>();
  listener->hall = hall;
  const std::vector<mocks::AntennaMounting> antennas{{1, {}, 0.0, 0.0}};
  if (slot) {
    listener->field =
        std::make_unique<mocks::SlotTagField>(hall->world, hall->body, antennas, air, hall->slots, seed);
  } else {
    listener->field = std::make_unique<mocks::SimTagField>(hall->world, hall->body, antennas, air, seed);
  }
  double mean = 0.0;
  for (int run = 0; run < runs; ++run) mean += static_cast<double>(listener->listen()) / runs;
  AccuracyRow row{
      .name = "tags read in 20 s, 20,000 tags in a hall",
      .variant = fmt::format("{}, cut {}, {}", slot ? "slot" : "round", cut, grid ? "grid" : "none"),
      .reference = fmt::format("sum of 1 - exp(-hazard t), extended precision; mean of {} runs", runs)};
  row.max_abs_error = std::abs(mean - static_cast<double>(hall->expected));
  row.max_rel_error = row.max_abs_error / static_cast<double>(hall->expected);
  row.asked = static_cast<std::uint64_t>(runs);
  row.items = kListen_s;
  row.work = [listener] { (void)listener->listen(); };
  return row;
}

constexpr std::uint32_t kFrameTags = 64;
constexpr int kFrameQ = 6;

// Tags alone in their slot of one frame, drawn slot by slot.
struct DrawnFrame {
  mocks::SlotRound round{kFrameTags};
  hal::Random random{1};
  int singles() {
    round.clear();
    for (std::uint32_t tag = 0; tag < kFrameTags; ++tag) round.join(tag);
    round.start({kFrameQ, 0.0});
    int count = 0;
    for (int slot = 0; slot < 1 << kFrameQ; ++slot) {
      const std::size_t replies = round.open_slot(random).size();
      if (replies == 0) round.heard_nothing();
      if (replies > 1) round.heard_collision();
      if (replies == 1) {
        round.heard_one(0);
        ++count;
      }
    }
    return count;
  }
};

// The same by tags that count slots as the standard says.
struct CountedFrame {
  mocks::SessionFlags flags{kFrameTags, mocks::AirParameters{}, 1};
  std::vector<mocks::SlotTag> tags;
  CountedFrame() {
    for (std::uint32_t i = 0; i < kFrameTags; ++i) {
      tags.emplace_back(flags, i, i);
      tags.back().power_on(0.0, 1);
    }
  }
  int singles() {
    int count = 0;
    for (int slot = 0; slot < 1 << kFrameQ; ++slot) {
      int replies = 0;
      for (mocks::SlotTag& tag : tags)
        replies += (slot == 0 ? tag.query({.session = 2, .q = kFrameQ}, 0.0) : tag.query_rep(2, 0.0)) ==
                           mocks::TagReply::rn16
                       ? 1
                       : 0;
      count += replies == 1 ? 1 : 0;
    }
    return count;
  }
};

template <class Frame>
AccuracyRow frame_row(const char* variant, int runs) {
  const auto frame = std::make_shared<Frame>();
  double mean = 0.0;
  for (int run = 0; run < runs; ++run) mean += static_cast<double>(frame->singles()) / runs;
  const double exact = kFrameTags * std::pow(1.0 - std::ldexp(1.0, -kFrameQ), kFrameTags - 1.0);
  AccuracyRow row{.name = "tags read in a frame of 64 slots, 64 tags",
                  .variant = variant,
                  .reference = fmt::format("n (1 - 1/L)^(n-1); mean of {} frames", runs)};
  row.max_abs_error = std::abs(mean - exact);
  row.max_rel_error = row.max_abs_error / exact;
  row.asked = static_cast<std::uint64_t>(runs);
  row.work = [frame] { (void)frame->singles(); };
  return row;
}

}  // namespace

std::vector<AccuracyRow> accuracy_air(const AccuracyOptions& options) {
  const auto hall = std::make_shared<Hall>(options.seed);
  const int runs = std::max(2, static_cast<int>(40.0 * options.effort));
  std::vector<AccuracyRow> rows;
  for (const bool slot : {false, true})
    for (const double cut : kCuts)
      for (const bool grid : {true, false})
        rows.push_back(inventory_row(hall, slot, cut, grid, runs, options.seed));
  const int frames = std::max(10, static_cast<int>(20'000.0 * options.effort));
  rows.push_back(frame_row<DrawnFrame>("slot by slot, binomial", frames));
  rows.push_back(frame_row<CountedFrame>("tag by tag, as the standard counts", std::max(10, frames / 20)));
  return rows;
}

}  // namespace forager::boards
