// Bytes that nobody should send, from strangers and to them: nothing crashes, nothing moves, and the reason
// is clear.
#include <gtest/gtest.h>

#include <array>
#include <csignal>
#include <deque>
#include <memory>
#include <span>

#include "hal/linux/tcp_listener.hpp"
#include "hal/linux/tcp_stream.hpp"
#include "hal/linux/udp_peer.hpp"
#include "hal/random.hpp"
#include "tests/tools/socket_rig.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;

class SocketGarbage : public SocketTest {};
using hal::ByteStream;

std::array<std::byte, 1024> garbage(hal::Random& random) {
  std::array<std::byte, 1024> bytes{};
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random.below(256));
  return bytes;
}

// Listens where a reader should be, and answers whatever comes with random bytes.
class RogueServer {
 public:
  RogueServer(const std::string& host, std::uint16_t port)
      : listener_(hal::TcpListener::listen(host, port).value()) {}
  void update() {
    while (auto caller = listener_.accept().value_or(nullptr)) callers_.push_back(std::move(caller));
    std::array<std::byte, 4096> heard{};
    for (auto& caller : callers_) {
      if (caller->poll().value_or(hal::StreamState::closed) != hal::StreamState::open) continue;
      (void)caller->read(heard);
      if (caller->write(garbage(random_)).value_or(0) > 0) ++spoken_;
    }
  }
  [[nodiscard]] int spoken() const { return spoken_; }

 private:
  hal::TcpListener listener_;
  std::vector<std::unique_ptr<ByteStream>> callers_;
  hal::Random random_{17};
  int spoken_ = 0;
};

// The same over UDP: keeps sending to whoever sent to it.
class RogueListener {
 public:
  RogueListener(const std::string& host, std::uint16_t port) : line_(hal::open_udp_listener(host, port)) {
    EXPECT_TRUE(line_->open().has_value());
  }
  void update() {
    if (line_->poll().value_or(hal::StreamState::closed) != hal::StreamState::open) return;
    std::array<std::byte, 2048> heard{};
    while (line_->read(heard).value_or(0) > 0) {
    }
    const auto bytes = garbage(random_);
    if (line_->write(std::span(bytes).first(1 + random_.below(300))).value_or(0) > 0) ++spoken_;
  }
  [[nodiscard]] int spoken() const { return spoken_; }

 private:
  std::unique_ptr<hal::UdpPeer> line_;
  hal::Random random_{18};
  int spoken_ = 0;
};

// Flies with the rogue in its place; what came of it.
template <class Rogue>
Json fly_against(SocketRig& rig, Rogue& rogue) {
  Program& mission = rig.start_mission();
  (void)mission.wait_until(
      [&rogue](const ProgramResult&) {
        rogue.update();
        return false;
      },
      kPatience);
  const ProgramResult flown = mission.finish();
  EXPECT_EQ(flown.exit_code, 1) << flown.out << flown.err;
  EXPECT_EQ(flown.signal, 0);
  EXPECT_GT(rogue.spoken(), 0) << "the mission never listened to it";
  return last_event(flown.out, "summary");
}

SocketRig::Options short_start() {
  SocketRig::Options options;
  options.links = "start_timeout_s = 30.0";
  return options;
}

TEST_F(SocketGarbage, AStreamOfNoiseMovesNothing) {
  SocketRig::Options options = short_start();
  options.rogue_stream = true;
  SocketRig rig(options);
  rig.start_reader();
  rig.start_autopilot();
  RogueServer rogue(rig.host, rig.rogue_port);
  const Json summary = fly_against(rig, rogue);
  EXPECT_EQ(summary["end_reason"], "reader_lost") << summary;
  EXPECT_NE(summary["detail"].get<std::string>().find("stream"), std::string::npos) << summary;
  EXPECT_EQ(summary["path_m"], 0.0) << summary;
  EXPECT_EQ(summary["reads"], 0) << summary;
  EXPECT_FALSE(rig.autopilot_armed());
}

TEST_F(SocketGarbage, AReaderThatAnswersNoiseMovesNothing) {
  SocketRig rig(short_start());
  rig.start_autopilot();
  RogueServer rogue(rig.host, rig.rest_port);
  const Json summary = fly_against(rig, rogue);
  EXPECT_EQ(summary["end_reason"], "reader_lost") << summary;
  EXPECT_NE(summary["detail"].get<std::string>().find("http"), std::string::npos) << summary;
  EXPECT_EQ(summary["path_m"], 0.0) << summary;
  EXPECT_FALSE(rig.autopilot_armed());
}

TEST_F(SocketGarbage, AnAutopilotThatSpeaksNoiseMovesNothing) {
  SocketRig rig(short_start());
  rig.start_reader();
  RogueListener rogue(rig.host, rig.mavlink_port);
  const Json summary = fly_against(rig, rogue);
  EXPECT_EQ(summary["end_reason"], "autopilot_lost") << summary;
  EXPECT_NE(summary["detail"].get<std::string>().find("heartbeat"), std::string::npos) << summary;
  EXPECT_EQ(summary["path_m"], 0.0) << summary;
}

void shout_tcp(const std::string& host, std::uint16_t port, hal::Random& random) {
  const auto line = hal::open_tcp_stream(host, port);
  ASSERT_TRUE(line->open().has_value());
  for (int i = 0; i < 20; ++i) {
    const auto state = line->poll();
    if (!state || *state == hal::StreamState::closed) return;
    if (*state == hal::StreamState::open && !line->write(garbage(random))) return;
  }
}

void shout_udp(const std::string& host, std::uint16_t port, hal::Random& random) {
  const auto line = hal::open_udp_peer(host, port);
  ASSERT_TRUE(line->open().has_value());
  for (int i = 0; i < 20; ++i) (void)line->write(garbage(random));
}

// Strangers were at every port first; the mission that comes after them flies as if they had not.
TEST_F(SocketGarbage, EmulatorsShrugOffStrangers) {
  SocketRig rig({.mission = "time_limit_s = 10.0"});
  rig.start_reader();
  rig.start_autopilot();
  hal::Random random(19);
  for (int i = 0; i < 30; ++i) {
    shout_tcp(rig.host, rig.rest_port, random);
    shout_tcp(rig.host, rig.stream_port, random);
    shout_udp(rig.host, rig.mavlink_port, random);
    shout_udp(rig.host, rig.air_port, random);
  }
  const ProgramResult flown = rig.start_mission().finish();
  const Json summary = last_event(flown.out, "summary");
  EXPECT_EQ(flown.exit_code, 0) << flown.err;
  EXPECT_EQ(summary["end_reason"], "time_limit") << summary;
  EXPECT_GE(summary["tags_read"], 4) << summary;
}

}  // namespace
}  // namespace forager::tools
