// On wheels: attitude and thrust push the vehicle, nothing flies.
#include <algorithm>
#include <cmath>

#include "mocks/sim_autopilot.hpp"

namespace forager::mocks {
namespace {

constexpr double kUnit = 1e-3;         // how far a quaternion's length may be off
constexpr double kThrustLands = 0.02;  // below it the land detector counts the time

}  // namespace

void SimAutopilot::put_on_wheels(RollingVehicle* wheels) {
  if (wheels_ != nullptr)
    vehicle_.stand_at(wheels_->state().pose);
  else if (wheels != nullptr && started_)
    wheels->stand_at(vehicle_.state().pose);
  wheels_ = wheels;
}

// SET_ATTITUDE_TARGET as ArduCopter 4.6 GUIDED reads it: all three rates or none, never without thrust, a
// quaternion of unit length. Not in flight: nothing here flies attitudes.
void SimAutopilot::hear_attitude(const MavlinkPayload& m) {
  constexpr unsigned kRates = 0x07;
  constexpr unsigned kIgnoreThrottle = 0x40;
  constexpr unsigned kIgnoreAttitude = 0x80;
  const auto system = m.get<std::uint8_t>(36);
  const auto component = m.get<std::uint8_t>(37);
  if ((system != 0 && system != config_.system) || (component != 0 && component != config_.component)) return;
  const unsigned mask = m.get<std::uint8_t>(38);
  const double w = m.f32(4);
  const double x = m.f32(8);
  const double y = m.f32(12);
  const double z = m.f32(16);
  const double thrust = m.f32(32);
  const bool rates_fit = (mask & kRates) == kRates || (mask & kRates) == 0;
  const bool unit = std::abs(std::sqrt(w * w + x * x + y * y + z * z) - 1.0) <= kUnit;
  const bool usable =
      rates_fit && (mask & (kIgnoreThrottle | kIgnoreAttitude)) == 0 && unit && std::isfinite(thrust);
  if (wheels_ == nullptr || mode_ != peer::CopterMode::guided || !armed_ || !usable ||
      faults_.ignore_setpoints) {
    ++setpoints_ignored_;
    return;
  }
  ++setpoints_taken_;
  // Without GUID_OPTIONS bit 3 it is a climb rate, and the wheels stay on the ground.
  attitude_.thrust = config_.guided_thrust ? std::clamp(thrust, 0.0, 1.0) : 0.0;
  // Nose up is positive in its frame.
  attitude_.pitch_rad = -std::asin(std::clamp(2.0 * (w * y - z * x), -1.0, 1.0));
  attitude_.heard = clock_;
  attitude_.fresh = true;
}

// After GUID_TIMEOUT without a target the body is levelled and thrust stays where it was. Disarmed, motors
// stop. With hardly any thrust the land detector soon says landed.
void SimAutopilot::roll() {
  if (attitude_.fresh && clock_ - attitude_.heard >= config_.guided_timeout) {
    attitude_.fresh = false;
    attitude_.pitch_rad = 0.0;
    note("guided attitude timed out: level");
  }
  if (!armed_ || mode_ != peer::CopterMode::guided) attitude_ = {};
  wheels_->set_armed(armed_);
  wheels_->push(wheel_thrust(), wheel_pitch_rad());
  wheels_->update(clock_);
  if (attitude_.thrust > kThrustLands) {
    landed_ = false;
    touched_at_ = clock_;
  }
}

void SimAutopilot::relay_stop(std::uint8_t system, std::uint8_t component) {
  MavlinkPayload p;  // param1 0: disarm
  p.put(28, peer::kComponentArmDisarm);
  p.put(30, system);
  p.put(31, component);
  link_.send(peer::kCommandLong, p, clock_);
}

}  // namespace forager::mocks
