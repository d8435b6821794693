#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "flight/mavlink_autopilot.hpp"
#include "mocks/mavlink_peer.hpp"
#include "mocks/memory_stream.hpp"
#include "mocks/text_journal.hpp"

namespace forager::flight::test {

namespace peer = mocks::peer;
using mocks::MavlinkPayload;
using mocks::MavlinkPeerFrame;

// A MavlinkAutopilot on a line in memory, with the test as the autopilot at the other end. The far end packs
// and reads frames with the emulator's own codec, not the one under test.
class AutopilotBench {
 public:
  static constexpr hal::Duration kStep = std::chrono::milliseconds(20);

  explicit AutopilotBench(const MavlinkConfig& config = {},
                          mocks::MemoryStreamKind kind = mocks::MemoryStreamKind::datagrams)
      : line_("udp autopilot", kind), ours_(make(config)) {
    (void)line_.far().open();
    ours_->update(now_);
  }

  MavlinkAutopilot& ours() { return *ours_; }
  mocks::MemoryStreamPair& line() { return line_; }
  mocks::TextJournal& journal() { return journal_; }
  [[nodiscard]] hal::Instant now() const { return now_; }

  // Lets time pass, the owner alive unless said otherwise; a heartbeat of the autopilot once a second.
  void run(hal::Duration time) {
    for (const hal::Instant end = now_ + time; now_ < end;) step();
  }
  void step() {
    now_ += kStep;
    if (heartbeats_ && now_ >= next_heartbeat_) {
      next_heartbeat_ = now_ + std::chrono::seconds(1);
      send_heartbeat();
    }
    if (owner_alive_) ours_->feed_deadman(now_);
    ours_->update(now_);
    listen();
  }

  void send_heartbeat() { send_heartbeat(packer_, 3); }
  void send_heartbeat(mocks::MavlinkPeerPacker& from, std::uint8_t autopilot) {
    MavlinkPayload p;
    p.put<std::uint32_t>(0, mode_);
    p.put<std::uint8_t>(4, 13);
    p.put<std::uint8_t>(5, autopilot);
    p.put<std::uint8_t>(6, static_cast<std::uint8_t>(1 + (armed_ ? 128 : 0)));
    p.put<std::uint8_t>(7, 4);
    p.put<std::uint8_t>(8, 3);
    send(from, peer::kHeartbeat, p);
  }
  void send_ack(std::uint16_t command, std::uint8_t result, std::uint8_t system = 1,
                std::uint8_t component = 191) {
    MavlinkPayload p;
    p.put(0, command);
    p.put(2, result);
    p.put(8, system);
    p.put(9, component);
    send(peer::kCommandAck, p);
  }
  void send_text(std::uint8_t severity, std::string_view text) {
    MavlinkPayload p;
    p.put(0, severity);
    p.text(1, 50, text);
    send(peer::kStatustext, p);
  }
  void send(const peer::MessageKind& kind, const MavlinkPayload& payload) { send(packer_, kind, payload); }
  void send(mocks::MavlinkPeerPacker& from, const peer::MessageKind& kind, const MavlinkPayload& payload) {
    (void)line_.far().poll();
    if (line_.far().state() == hal::StreamState::open) (void)line_.far().write(from.pack(kind, payload));
  }

  // Everything the bridge has sent since the last clear().
  [[nodiscard]] const std::vector<MavlinkPeerFrame>& heard() const { return heard_; }
  void clear() { heard_.clear(); }
  [[nodiscard]] std::vector<MavlinkPeerFrame> heard(const peer::MessageKind& kind) const {
    std::vector<MavlinkPeerFrame> found;
    for (const auto& frame : heard_)
      if (frame.id == kind.id) found.push_back(frame);
    return found;
  }
  // COMMAND_LONGs of one command: 28 command, 32 confirmation, 0.. params.
  [[nodiscard]] std::vector<MavlinkPeerFrame> commands(std::uint16_t command) const {
    std::vector<MavlinkPeerFrame> found;
    for (const auto& frame : heard(peer::kCommandLong))
      if (frame.payload.get<std::uint16_t>(28) == command) found.push_back(frame);
    return found;
  }

  // Brings the link up in GUIDED, and forgets what was said so far.
  void connect() {
    mode_ = 4;
    run(std::chrono::seconds(2));
    clear();
  }

  void owner_alive(bool alive) { owner_alive_ = alive; }
  void heartbeats(bool on) { heartbeats_ = on; }
  void mode(std::uint32_t mode) { mode_ = mode; }
  void armed(bool armed) { armed_ = armed; }

 private:
  std::unique_ptr<MavlinkAutopilot> make(const MavlinkConfig& config) {
    return std::move(
        MavlinkAutopilot::create(line_.near(), journal_, config, now_, MotorBay().claim("autopilot").value())
            .value());
  }
  void listen() {
    std::array<std::byte, 2048> bytes;
    (void)line_.far().poll();
    while (line_.far().state() == hal::StreamState::open) {
      const auto count = line_.far().read(bytes);
      if (!count || *count == 0) return;
      for (std::span<const std::byte> rest = std::span(bytes).first(*count); !rest.empty();) {
        rest = rest.subspan(parser_.push(rest));
        while (const auto* frame = parser_.next()) heard_.push_back(*frame);
      }
    }
  }

  hal::Instant now_{std::chrono::seconds(1000)};
  mocks::TextJournal journal_;
  mocks::MemoryStreamPair line_;
  std::unique_ptr<MavlinkAutopilot> ours_;
  mocks::MavlinkPeerPacker packer_{1, 1};
  mocks::MavlinkPeerParser parser_;
  std::vector<MavlinkPeerFrame> heard_;
  hal::Instant next_heartbeat_{};
  bool heartbeats_ = true;
  bool owner_alive_ = true;
  bool armed_ = false;
  std::uint32_t mode_ = 0;
};

}  // namespace forager::flight::test
