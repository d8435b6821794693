#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "hal/byte_stream.hpp"
#include "hal/time.hpp"
#include "mocks/body.hpp"
#include "mocks/mavlink_peer.hpp"

namespace forager::mocks {

// A BodyState as one MAVLink ODOMETRY (331): frame LOCAL_FRD is the world turned to x forward, y right, z
// down; child BODY_FRD holds velocities in the body's own axes; q is body to frame, w first; time_usec is the
// run's time. reset_counter carries two flags: bit 0 armed, bit 1 on the ground. Positions are floats: below
// 1e-5 m off within 100 m. Only the yaw rate is sent, the other rates are 0.
[[nodiscard]] MavlinkPayload encode_truth(const BodyState& body, hal::Instant now);
// Nothing if the frames differ, the quaternion is no rotation or a number is not finite.
[[nodiscard]] std::optional<BodyState> decode_truth(const MavlinkPayload& odometry);

// Tells emulators in other processes where the vehicle really is: one datagram per interval.
class TruthFeed {
 public:
  TruthFeed(const TrueBody& body, hal::ByteStream& stream, hal::Duration interval)
      : body_(&body), stream_(&stream), interval_(interval) {}
  // Opens the stream when needed, at most once a second. A feed that nobody hears is no error.
  void update(hal::Instant now);
  [[nodiscard]] std::uint64_t sent() const { return sent_; }

 private:
  const TrueBody* body_;
  hal::ByteStream* stream_;
  hal::Duration interval_;
  MavlinkPeerPacker packer_{255, 250};
  std::optional<hal::Instant> next_;
  std::optional<hal::Instant> tried_;
  std::uint64_t sent_ = 0;
};

// The other end: the body as last told. Until the first datagram it stands at the start. A line on which
// nothing of use comes for 2 s is closed and opened again: a socket that keeps to the first that spoke to it
// hears a teller that was started anew, or that a stranger was ahead of.
class TruthFollower : public TrueBody {
 public:
  explicit TruthFollower(hal::ByteStream& stream, BodyState start = {}) : stream_(&stream), state_(start) {}
  void update(hal::Instant now);
  [[nodiscard]] const BodyState& state() const override { return state_; }
  // Something was heard within `age`.
  [[nodiscard]] bool fresh(hal::Instant now, hal::Duration age) const {
    return heard_ && now - *heard_ <= age;
  }
  // The teller's own time of the state, nullopt before the first.
  [[nodiscard]] std::optional<hal::Instant> told_at() const { return told_at_; }

 private:
  void listen(hal::Instant now);
  void hear(const MavlinkPeerFrame& frame, hal::Instant now);

  hal::ByteStream* stream_;
  BodyState state_;
  MavlinkPeerParser parser_;
  std::array<std::byte, 2048> room_{};
  std::optional<hal::Instant> heard_;
  std::optional<hal::Instant> told_at_;
  std::optional<hal::Instant> quiet_since_;
  std::optional<hal::Instant> tried_;
};

}  // namespace forager::mocks
