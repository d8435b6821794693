#include "mocks/truth_feed.hpp"

#include <algorithm>
#include <cmath>

#include "hal/units.hpp"

namespace forager::mocks {
namespace {

using hal::Vec3;

constexpr hal::Duration kReopen = std::chrono::seconds(1);
constexpr hal::Duration kPatience = std::chrono::seconds(2);  // with a teller that says nothing of use
constexpr unsigned kArmed = 1;
constexpr unsigned kOnGround = 2;
constexpr double kUpright = 1.0 - 5e-7;  // sine of a pitch within 1e-3 rad of 90 degrees

struct Quaternion {
  double w, x, y, z;
};

// Yaw, pitch, roll about z, y', x'', in whichever frame the angles are given.
Quaternion from_angles(double yaw, double pitch, double roll) {
  const double cy = std::cos(0.5 * yaw), sy = std::sin(0.5 * yaw);
  const double cp = std::cos(0.5 * pitch), sp = std::sin(0.5 * pitch);
  const double cr = std::cos(0.5 * roll), sr = std::sin(0.5 * roll);
  return {cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
          cr * cp * sy - sr * sp * cy};
}

// v + 2 u x (u x v + w v): from the body to the frame; with the sign of u turned, back.
Vec3 rotate(Quaternion q, Vec3 v) {
  const Vec3 t{q.y * v.z - q.z * v.y + q.w * v.x, q.z * v.x - q.x * v.z + q.w * v.y,
               q.x * v.y - q.y * v.x + q.w * v.z};
  return v + 2.0 * Vec3{q.y * t.z - q.z * t.y, q.z * t.x - q.x * t.z, q.x * t.y - q.y * t.x};
}

// Forward-left-up and forward-right-down differ by half a turn about x, both ways the same.
Vec3 flip(Vec3 v) { return {v.x, -v.y, -v.z}; }

bool ready(hal::ByteStream& stream, std::optional<hal::Instant>& tried, hal::Instant now) {
  auto state = stream.poll();
  if (state && *state == hal::StreamState::open) return true;
  const bool idle = !state || *state == hal::StreamState::closed;
  if (!idle || (tried && now - *tried < kReopen)) return false;
  tried = now;
  if (!stream.open()) return false;
  state = stream.poll();
  return state && *state == hal::StreamState::open;
}

}  // namespace

MavlinkPayload encode_truth(const BodyState& body, hal::Instant now) {
  MavlinkPayload p;
  const hal::Pose& pose = body.pose;
  const Quaternion q = from_angles(-pose.yaw_rad, -pose.pitch_rad, pose.roll_rad);
  const Vec3 at = flip(pose.position);
  const Vec3 v = rotate({q.w, -q.x, -q.y, -q.z}, flip(body.velocity_world_m_s));
  const auto us = std::chrono::floor<std::chrono::microseconds>(now.time_since_epoch()).count();
  p.put(0, static_cast<std::uint64_t>(us));
  const std::array numbers{at.x, at.y, at.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z};
  for (std::size_t i = 0; i < numbers.size(); ++i) p.f32(8 + 4 * i, numbers[i]);
  p.f32(56, -body.yaw_rate_rad_s);
  p.put(228, peer::kLocalFrd);
  p.put(229, peer::kBodyFrd);
  p.put(230, static_cast<std::uint8_t>((body.armed ? kArmed : 0U) | (body.on_ground ? kOnGround : 0U)));
  p.put(232, std::int8_t{100});  // quality: the truth
  return p;
}

std::optional<BodyState> decode_truth(const MavlinkPayload& p) {
  if (p.get<std::uint8_t>(228) != peer::kLocalFrd || p.get<std::uint8_t>(229) != peer::kBodyFrd) return {};
  const Vec3 at{p.f32(8), p.f32(12), p.f32(16)};
  Quaternion q{p.f32(20), p.f32(24), p.f32(28), p.f32(32)};
  const Vec3 v{p.f32(36), p.f32(40), p.f32(44)};
  const double rate = p.f32(56);
  const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!hal::is_finite(at) || !hal::is_finite(v) || !std::isfinite(rate) || !(std::abs(length - 1.0) < 1e-3))
    return {};
  q = {q.w / length, q.x / length, q.y / length, q.z / length};
  BodyState body;
  body.pose.position = flip(at);
  const double sine = std::clamp(2.0 * (q.w * q.y - q.z * q.x), -1.0, 1.0);
  body.pose.pitch_rad = -std::asin(sine);
  if (std::abs(sine) > kUpright) {
    // Straight up or down only the sum or difference of yaw and roll is left of floats.
    body.pose.yaw_rad = 2.0 * std::copysign(1.0, sine) * std::atan2(q.x, q.w);
    body.pose.roll_rad = 0.0;
  } else {
    body.pose.yaw_rad = -std::atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z));
    body.pose.roll_rad = std::atan2(2.0 * (q.w * q.x + q.y * q.z), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
  }
  body.pose.yaw_rad = hal::wrap_pi(body.pose.yaw_rad);
  body.velocity_world_m_s = flip(rotate(q, v));
  body.yaw_rate_rad_s = -rate;
  const unsigned flags = p.get<std::uint8_t>(230);
  body.armed = (flags & kArmed) != 0;
  body.on_ground = (flags & kOnGround) != 0;
  return body;
}

void TruthFeed::update(hal::Instant now) {
  if (next_ && now < *next_) return;
  // Missed turns are not made up for.
  next_ = next_ ? std::max(*next_ + interval_, now) : now + interval_;
  if (!ready(*stream_, tried_, now)) return;
  const auto frame = packer_.pack(peer::kOdometry, encode_truth(body_->state(), now));
  const auto written = stream_->write(frame);
  if (written && *written == frame.size()) ++sent_;
}

void TruthFollower::update(hal::Instant now) {
  if (!ready(*stream_, tried_, now)) {
    quiet_since_.reset();
    return;
  }
  if (!quiet_since_) quiet_since_ = now;
  listen(now);
  if (now - *quiet_since_ < kPatience) return;
  stream_->close();
  tried_.reset();
}

void TruthFollower::listen(hal::Instant now) {
  for (;;) {
    const auto count = stream_->read(room_);
    if (!count || *count == 0) return;
    auto bytes = std::span<const std::byte>(room_).first(*count);
    while (!bytes.empty()) {
      bytes = bytes.subspan(parser_.push(bytes));
      while (const MavlinkPeerFrame* frame = parser_.next()) hear(*frame, now);
    }
  }
}

void TruthFollower::hear(const MavlinkPeerFrame& frame, hal::Instant now) {
  if (frame.id != peer::kOdometry.id) return;
  const auto body = decode_truth(frame.payload);
  const auto us = frame.payload.get<std::int64_t>(0);
  constexpr std::int64_t kCenturies = 9'000'000'000'000'000;  // the end of the time line, in microseconds
  if (!body || us < 0 || us > kCenturies) return;
  state_ = *body;
  heard_ = quiet_since_ = now;
  told_at_ = hal::Instant(std::chrono::microseconds(us));
}

}  // namespace forager::mocks
