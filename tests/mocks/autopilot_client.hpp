#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hal/units.hpp"
#include "mocks/mavlink_peer.hpp"
#include "mocks/memory_stream.hpp"
#include "mocks/sim_autopilot.hpp"

namespace forager::mocks {

// A companion computer reduced to what the tests of the emulated autopilot need: it sends true or bent poses
// as vision at 30 Hz, commands and setpoints, and keeps the newest message of each kind.
class AutopilotBench {
 public:
  explicit AutopilotBench(SimAutopilotConfig config = {}, MemoryStreamKind kind = MemoryStreamKind::datagrams)
      : line_("test line", kind), sim_(line_.far(), config) {
    (void)line_.near().open();
    (void)line_.near().poll();
  }

  SimAutopilot& sim() { return sim_; }
  const BodyState& truth() const { return sim_.state(); }
  hal::Instant now() const { return now_; }
  MemoryStreamPair& line() { return line_; }

  // Runs on in ticks of 20 ms; `each` is called before each tick of the autopilot.
  void run(hal::Duration length, const std::function<void()>& each = {}) {
    const hal::Instant end = now_ + length;
    while (now_ < end) {
      now_ += tick;
      if (vision && now_ >= next_vision_) {
        next_vision_ = now_ + std::chrono::milliseconds(33);
        send_vision();
      }
      if (each) each();
      sim_.update(now_);
      listen();
    }
  }

  void send(const peer::MessageKind& kind, const MavlinkPayload& payload) {
    (void)line_.near().write(packer_.pack(kind, payload));
  }

  // Where the vehicle is, as a camera would say, with the offset and the turned frame below.
  void send_vision() {
    const hal::Pose& pose = truth().pose;
    MavlinkPayload p;
    p.put(0, static_cast<std::uint64_t>(now_.time_since_epoch().count() / 1000));
    const hal::Vec3 at = hal::rotate_yaw(pose.position + vision_offset, vision_frame_yaw);
    p.f32(8, at.x);
    p.f32(12, -at.y);
    p.f32(16, -at.z);
    p.f32(20, pose.roll_rad);
    p.f32(24, -pose.pitch_rad);
    p.f32(28, hal::wrap_pi(-pose.yaw_rad - vision_frame_yaw - vision_yaw_error));
    p.put(116, reset_counter);
    send(peer::kVisionPositionEstimate, p);
  }

  void send_origin() {
    MavlinkPayload p;
    p.put(0, std::int32_t{414036000});
    p.put(4, std::int32_t{21744000});
    p.put(8, std::int32_t{100000});
    p.put(12, std::uint8_t{1});
    send(peer::kSetGpsGlobalOrigin, p);
  }

  // Sends a COMMAND_LONG and returns the result that came back within 200 ms.
  std::optional<peer::Result> command(std::uint16_t id, std::vector<double> params = {}) {
    MavlinkPayload p;
    for (std::size_t i = 0; i < params.size(); ++i) p.f32(4 * i, params[i]);
    p.put(28, id);
    p.put(30, std::uint8_t{1});
    p.put(31, std::uint8_t{1});
    last.erase(peer::kCommandAck.id);
    send(peer::kCommandLong, p);
    run(std::chrono::milliseconds(200));
    const auto ack = last.find(peer::kCommandAck.id);
    if (ack == last.end() || ack->second.payload.get<std::uint16_t>(0) != id) return std::nullopt;
    return static_cast<peer::Result>(ack->second.payload.get<std::uint8_t>(2));
  }

  void stream(const peer::MessageKind& kind, double hz) {
    (void)command(peer::kSetMessageInterval, {static_cast<double>(kind.id), 1e6 / hz});
  }

  // Vector in the frame's own axes (NED or FRD).
  void setpoint(std::uint16_t mask, hal::Vec3 position, hal::Vec3 velocity = {}, double yaw = 0.0,
                double yaw_rate = 0.0, std::uint8_t frame = peer::kLocalNed) {
    MavlinkPayload p;
    p.f32(4, position.x);
    p.f32(8, position.y);
    p.f32(12, position.z);
    p.f32(16, velocity.x);
    p.f32(20, velocity.y);
    p.f32(24, velocity.z);
    p.f32(40, yaw);
    p.f32(44, yaw_rate);
    p.put(48, mask);
    p.put(50, std::uint8_t{1});
    p.put(51, std::uint8_t{1});
    p.put(52, frame);
    send(peer::kSetPositionTargetLocalNed, p);
  }

  // Origin, vision, GUIDED, armed, hovering at the height.
  void fly(double height_m = 1.5) {
    send_origin();
    run(std::chrono::seconds(2));
    (void)command(peer::kDoSetMode, {1, 4});
    (void)command(peer::kComponentArmDisarm, {1});
    (void)command(peer::kNavTakeoff, {0, 0, 0, 0, 0, 0, height_m});
    run(std::chrono::seconds(8));
  }

  bool heard_text(std::string_view part) const {
    for (const std::string& text : texts)
      if (text.find(part) != std::string::npos) return true;
    return false;
  }
  std::uint64_t count(const peer::MessageKind& kind) const {
    const auto found = counts.find(kind.id);
    return found == counts.end() ? 0 : found->second;
  }
  const MavlinkPayload& message(const peer::MessageKind& kind) { return last[kind.id].payload; }

  hal::Duration tick = std::chrono::milliseconds(20);
  bool vision = true;
  hal::Vec3 vision_offset;        // world frame
  double vision_frame_yaw = 0.0;  // heading of the world's x in the camera's frame, left positive
  double vision_yaw_error = 0.0;
  std::uint8_t reset_counter = 0;
  std::map<std::uint32_t, MavlinkPeerFrame> last;
  std::map<std::uint32_t, std::uint64_t> counts;
  std::vector<std::string> texts;
  std::vector<std::byte> heard;  // every byte the autopilot sent
  std::uint64_t lost = 0;        // by sequence numbers
  const MavlinkPeerParser& parser() const { return parser_; }

 private:
  void listen() {
    std::array<std::byte, 512> room{};
    for (;;) {
      const auto count = line_.near().read(room);
      if (!count || *count == 0) return;
      const auto bytes = std::span<const std::byte>(room).first(*count);
      heard.insert(heard.end(), bytes.begin(), bytes.end());
      (void)parser_.push(bytes);
      while (const MavlinkPeerFrame* frame = parser_.next()) keep(*frame);
    }
  }

  void keep(const MavlinkPeerFrame& frame) {
    if (sequence_) lost += static_cast<std::uint8_t>(frame.sequence - *sequence_ - 1);
    sequence_ = frame.sequence;
    last[frame.id] = frame;
    ++counts[frame.id];
    if (frame.id != peer::kStatustext.id) return;
    const auto text = frame.payload.bytes(51).subspan(1);
    std::string line;
    for (const std::byte b : text)
      if (b != std::byte{0}) line += static_cast<char>(b);
    texts.push_back(line);
  }

  MemoryStreamPair line_;
  SimAutopilot sim_;
  MavlinkPeerPacker packer_{1, 191};
  MavlinkPeerParser parser_;
  hal::Instant now_{std::chrono::seconds(5)};
  hal::Instant next_vision_;
  std::optional<std::uint8_t> sequence_;
};

}  // namespace forager::mocks
