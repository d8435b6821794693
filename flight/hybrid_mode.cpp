#include "flight/hybrid_mode.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "hal/units.hpp"

namespace forager::flight {
namespace {

constexpr std::string_view kSource = "hybrid";

}  // namespace

std::string_view to_string(GroundState state) {
  constexpr std::array<std::string_view, 5> kNames{"parked", "driving", "arrived", "blocked", "failed"};
  return kNames[static_cast<std::size_t>(state)];
}

std::string_view to_string(HybridPhase phase) {
  constexpr std::array<std::string_view, 9> kNames{"rolling", "standing", "guided",  "arming", "climbing",
                                                   "flying",  "landing",  "stopped", "done"};
  return kNames[static_cast<std::size_t>(phase)];
}

std::string_view to_string(HybridEnd end) {
  constexpr std::array<std::string_view, 12> kNames{
      "none",    "arrived", "ground_failed", "no_way",         "off_takeoff", "refused",
      "battery", "late",    "pose_lost",     "autopilot_lost", "pilot",       "halted"};
  return kNames[static_cast<std::size_t>(end)];
}

HybridMode::HybridMode(const HybridConfig& config, const HybridDevices& devices, HybridRoute route,
                       std::vector<HopObstacle> known, hal::Instant now)
    : config_(config),
      autopilot_(&devices.autopilot),
      ground_(&devices.ground),
      journal_(&devices.journal),
      route_(std::move(route)),
      known_(std::move(known)),
      localisation_(devices.pose, devices.autopilot, devices.journal, devices.vision),
      flight_(config.flight) {
  enter(HybridPhase::standing, now);
  if (route_.legs.empty()) set_end(HybridEnd::arrived, "nowhere to go", now), enter(HybridPhase::done, now);
}

HybridMode::~HybridMode() {
  if (!done()) halt();
}

// What the next update() would do may never be done. On the ground and disarmed there is nothing to stop; who
// has the vehicle in the air is the autopilot bridge's to know.
void HybridMode::halt() noexcept {
  halt_asked_ = true;
  if (status_.phase == HybridPhase::rolling)
    ground_->halt();
  else if (status_.phase != HybridPhase::standing && !done() && status_.end != HybridEnd::pilot)
    autopilot_->halt();
}

void HybridMode::update(hal::Instant now) {
  ground_->update(now);
  if (status_.phase == HybridPhase::rolling) return roll(now);
  if (done()) return;
  autopilot_->feed_deadman(now);
  autopilot_->update(now);
  localisation_.update(now);
  if (const auto pose = localisation_.pose_world()) status_.pose_world = *pose;
  const bool moves = hal::norm(autopilot_->state().velocity_world_m_s) > config_.stands_m_s;
  if (moves)
    still_since_.reset();
  else if (!still_since_)
    still_since_ = now;
  switch (status_.phase) {
    case HybridPhase::standing:
      return stand(now);
    case HybridPhase::guided:
      return wait_for_mode(now);
    case HybridPhase::arming:
      return wait_for_arming(now);
    case HybridPhase::climbing:
      return climb(now);
    case HybridPhase::flying:
      return fly(now);
    case HybridPhase::landing:
      return land(now);
    case HybridPhase::stopped:
      return come_down(now);
    case HybridPhase::rolling:
    case HybridPhase::done:
      return;
  }
}

void HybridMode::roll(hal::Instant now) {
  const GroundStatus& ground = ground_->status();
  if (halt_asked_) {
    ground_->halt();
    return stop(HybridEnd::halted, "asked to stop", now);
  }
  switch (ground.state) {
    case GroundState::driving:
      return;
    case GroundState::arrived:
      return leg_over(now);
    case GroundState::blocked:
      return hop_instead(ground.detail, now);
    case GroundState::parked:
    case GroundState::failed:
      return stop(HybridEnd::ground_failed, ground.detail, now);
  }
}

// Between two legs: the localisation is taken over from, or handed to, the ground driver.
void HybridMode::stand(hal::Instant now) {
  if (halt_asked_) return stop(HybridEnd::halted, "asked to stop", now);
  const AutopilotState& autopilot = autopilot_->state();
  const bool known = localisation_.healthy() && autopilot.link_up && autopilot.pose_valid;
  const bool still = still_since_ && now - *still_since_ >= config_.stand_for;
  if (known && still && !autopilot.armed && !autopilot.in_air && waited(config_.stand_for, now))
    return begin_leg(now);
  if (waited(config_.ask_timeout, now))
    stop(known ? HybridEnd::refused : HybridEnd::pose_lost,
         known ? "it does not stand still, or is armed by somebody else"
               : "no trustworthy pose, or no autopilot",
         now);
}

void HybridMode::begin_leg(hal::Instant now) {
  if (route_.legs[status_.leg].kind == HybridLeg::Kind::roll) return begin_roll(now);
  begin_hop(now);
}

void HybridMode::begin_roll(hal::Instant now) {
  // From where it stands, not from where it ought to.
  std::vector<hal::Vec3> way = route_.legs[status_.leg].way_world;
  way.front() = status_.pose_world.position;
  way.front().z = way.back().z;
  if (hal::distance_xy(way.front(), way.back()) <= 0.0) return leg_over(now);
  if (auto begun = ground_->begin(way, now); !begun)
    return stop(HybridEnd::ground_failed, hal::describe(begun.error()), now);
  enter(HybridPhase::rolling, now);
}

void HybridMode::begin_hop(hal::Instant now) {
  const double off_m = hal::distance_xy(status_.pose_world.position, hop().takeoff_world);
  if (off_m > config_.takeoff_off_m)
    return stop(HybridEnd::off_takeoff, fmt::format("{:.2f} m from where the hop begins", off_m), now);
  const auto battery = autopilot_->state().battery_fraction;
  if (battery && *battery < config_.battery_reserve)
    return stop(HybridEnd::battery, fmt::format("{:.0f} % left: no hop", 100.0 * *battery), now);
  floor_z_m_ = status_.pose_world.position.z;
  enter(HybridPhase::guided, now);
  autopilot_->request_guided(now);
}

void HybridMode::leg_over(hal::Instant now) {
  if (++status_.leg < route_.legs.size()) return enter(HybridPhase::standing, now);
  set_end(HybridEnd::arrived, "at the end of the way", now);
  enter(HybridPhase::done, now);
}

// The ground is not as free as the route thought: over it, if what stands there is known.
void HybridMode::hop_instead(std::string_view blocked, hal::Instant now) {
  const auto pose = localisation_.pose_world();
  const hal::Vec3 goal = route_.legs[status_.leg].way_world.back();
  // While rolling the ground driver has the localisation; the autopilot's estimate was fed by it.
  const hal::Vec3 here = autopilot_->state().pose_valid ? autopilot_->state().pose_world.position
                         : pose                         ? pose->position
                                                        : goal;
  const HopPlan plan = plan_hops(here, goal, known_, config_.hop);
  if (plan.reason != HopReason::hop)
    return stop(HybridEnd::no_way,
                fmt::format("{}; no hop over it: {} {}", blocked, to_string(plan.reason), plan.detail), now);
  std::vector<HybridLeg> legs;
  hal::Vec3 from = here;
  for (const Hop& over : plan.hops) {
    if (hal::distance_xy(from, over.takeoff_world) > config_.takeoff_off_m)
      legs.push_back({HybridLeg::Kind::roll, {from, over.takeoff_world}, {}});
    legs.push_back({HybridLeg::Kind::hop, {}, over});
    from = over.landing_world;
  }
  legs.push_back({HybridLeg::Kind::roll, {from, goal}, {}});
  const auto at = route_.legs.begin() + static_cast<std::ptrdiff_t>(status_.leg);
  route_.legs.insert(route_.legs.erase(at), legs.begin(), legs.end());
  journal_->note(now, kSource, "blocked on the ground: hops over it");
  enter(HybridPhase::standing, now);
}

bool HybridMode::waited(hal::Duration allowed, hal::Instant now) const {
  return now - status_.phase_since >= allowed;
}

void HybridMode::set_end(HybridEnd why, std::string_view detail, hal::Instant now) {
  if (status_.end != HybridEnd::none) return;
  status_.end = why;
  status_.detail = detail;
  journal_->note(now, kSource, fmt::format("end {}: {}", to_string(why), detail));
}

void HybridMode::enter(HybridPhase phase, hal::Instant now) {
  status_.phase = phase;
  status_.phase_since = now;
  still_since_.reset();
  fmt::basic_memory_buffer<char, 64> line;
  fmt::format_to(std::back_inserter(line), "leg {} {}", status_.leg + 1, to_string(phase));
  journal_->note(now, kSource, {line.data(), line.size()});
}

}  // namespace forager::flight
