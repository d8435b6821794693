#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "boards/accuracy_row.hpp"
#include "boards/running_moments.hpp"
#include "boards/sweep.hpp"
#include "mocks/gen2_field.hpp"
#include "mocks/gen2_slot_field.hpp"
#include "mocks/gen2_timing.hpp"

// What precision, cut, model of the air and grid cost and save in a whole inventory, counted in tags found.
namespace forager::boards {
namespace {

using mocks::PatternArithmetic;

constexpr double kCuts[] = {0.0, 1e-12, 1e-9, 1e-6};
constexpr bool kGrids[] = {true, false};
constexpr auto kTick = std::chrono::milliseconds(100);

std::string cut_and_grid(double cut, const char* model, bool grid) {
  return fmt::format("cut {:g}, {}{}", cut, model, grid ? "grid" : "none");
}

// Expected tags, without chance: the errors are those of arithmetic and cut alone.
std::vector<AccuracyRow> expectation_rows(const std::shared_ptr<const Sweep>& sweep) {
  using Way = SweepByKernel::Way;
  constexpr std::pair<Way, const char*> kWays[] = {
      {Way::f32, "f32"}, {Way::f64, "f64"}, {Way::compensated, "compensated"}};
  const double exact = sweep->expected_tags(sweep->exact_exposure);
  std::vector<AccuracyRow> rows;
  for (const auto& [way, name] : kWays)
    for (const double cut : kCuts)
      for (const bool grid : kGrids) {
        const auto engine = std::make_shared<SweepByKernel>(*sweep, way, cut, grid);
        AccuracyRow row{.name = fmt::format("tags a sweep finds, expected, of {}", sweep->world.tags.size()),
                        .variant = fmt::format("{}, {}", name, cut_and_grid(cut, "", grid)),
                        .reference = "the same expectation to 100 bits, no cut"};
        row.max_abs_error = std::abs(sweep->expected_tags(engine->exposure()) - exact);
        row.max_rel_error = row.max_abs_error / exact;
        row.asked = 1;
        row.work = [sweep, engine] { static_cast<void>(engine->exposure()); };
        row.items = static_cast<double>(Sweep::kPlaces * sweep->world.tags.size());
        rows.push_back(std::move(row));
      }
  return rows;
}

struct Carried final : mocks::TrueBody {
  mocks::BodyState body;
  [[nodiscard]] const mocks::BodyState& state() const override { return body; }
};

// Flies the sweep; gives the number of reads, each of another tag.
std::size_t fly(mocks::TagField& field, Carried& carried, const Sweep& sweep) {
  std::vector<mocks::AirRead> reads;
  hal::Instant now{};
  carried.body.pose.position = sweep.place(0.0);
  field.radio_on(
      {.session = 2, .target = 'A', .q = -1, .on_time = {}, .off_time = {}, .ports = {{1, 30.0, -200.0}}},
      now);
  while (now.time_since_epoch() < hal::from_seconds(Sweep::kDuration_s)) {
    now += kTick;
    carried.body.pose.position = sweep.place(hal::to_seconds(now));
    field.advance(now, reads);
  }
  return reads.size();
}

struct Found {
  std::size_t tags;
  double listened_share;
};

Found fly_rounds(const Sweep& sweep, const mocks::AirParameters& air, std::uint64_t seed) {
  Carried carried;
  carried.body.pose.position = sweep.place(0.0);
  mocks::SimTagField field(sweep.world, carried, {sweep.antenna}, air, seed);
  const std::size_t tags = fly(field, carried, sweep);
  const double silent_s = air.settle_s + air.singulation_s * static_cast<double>(tags);
  return {tags, 1.0 - silent_s / Sweep::kDuration_s};
}

Found fly_slots(const Sweep& sweep, const mocks::AirParameters& air, std::uint64_t seed) {
  Carried carried;
  carried.body.pose.position = sweep.place(0.0);
  mocks::SlotParameters slots;
  slots.decode_half_dbm = -500.0;  // every reply is understood
  mocks::SlotTagField field(sweep.world, carried, {sweep.antenna}, air, slots, seed);
  const std::size_t tags = fly(field, carried, sweep);
  const auto times = mocks::slot_times(slots.link);
  const mocks::SlotStatistics& s = field.statistics();
  const double busy_us =
      times.success_us * static_cast<double>(s.single) + times.collided_us * static_cast<double>(s.collided);
  return {tags, 1.0 - (air.settle_s + 1e-6 * busy_us) / Sweep::kDuration_s};
}

using Flight = Found (*)(const Sweep&, const mocks::AirParameters&, std::uint64_t);

// Whole missions by the two models of the air. They draw: `runs` of them, the same seeds for all.
AccuracyRow mission_row(const std::shared_ptr<const Sweep>& sweep, Flight flight,
                        const mocks::AirParameters& air, std::string variant, std::uint64_t runs) {
  RunningMoments found;
  RunningMoments expected;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
    const Found one = flight(*sweep, air, seed);
    found.add(static_cast<double>(one.tags));
    expected.add(sweep->expected_tags(sweep->exact_exposure, one.listened_share));
  }
  AccuracyRow row{.name = fmt::format("tags a flown sweep finds, mean of {} runs", runs),
                  .variant = std::move(variant),
                  .reference = fmt::format("expectation to 100 bits, {:.0f} tags; chance alone: {:.1f}",
                                           expected.mean(), found.standard_error())};
  row.max_abs_error = std::abs(found.mean() - expected.mean());
  row.max_rel_error = row.max_abs_error / expected.mean();
  row.asked = runs;
  row.work = [sweep, flight, air] { static_cast<void>(flight(*sweep, air, 1)); };
  return row;
}

std::vector<AccuracyRow> mission_rows(const std::shared_ptr<const Sweep>& sweep, std::uint64_t runs) {
  constexpr std::pair<PatternArithmetic, const char*> kWays[] = {
      {PatternArithmetic::series_f32, "f32"},
      {PatternArithmetic::series, "f64"},
      {PatternArithmetic::trigonometry, "f64 libm"}};
  constexpr std::pair<Flight, const char*> kModels[] = {{fly_rounds, "round, "}, {fly_slots, "slot, "}};
  std::vector<AccuracyRow> rows;
  for (const auto& [way, name] : kWays)
    for (const double cut : kCuts)
      for (const auto& [flight, model] : kModels)
        for (const bool grid : kGrids) {
          mocks::AirParameters air = sweep->air;
          air.pattern = air.pattern.with(way);
          air.hazard_cut = cut;
          air.skip_by_grid = grid;
          rows.push_back(mission_row(sweep, flight, air,
                                     fmt::format("{}, {}", name, cut_and_grid(cut, model, grid)), runs));
        }
  return rows;
}

}  // namespace

std::vector<AccuracyRow> accuracy_sweep(const AccuracyOptions& options) {
  const double share = std::min(options.effort, 1.0);
  const auto tags = std::max<std::size_t>(100, static_cast<std::size_t>(1500.0 * share));
  const auto runs = std::max<std::uint64_t>(2, static_cast<std::uint64_t>(16.0 * options.effort));
  const auto sweep = std::make_shared<const Sweep>(options.seed, tags);
  std::vector<AccuracyRow> rows = expectation_rows(sweep);
  for (AccuracyRow& row : mission_rows(sweep, runs)) rows.push_back(std::move(row));
  return rows;
}

}  // namespace forager::boards
