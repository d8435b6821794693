#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "mocks/memory_stream.hpp"
#include "mocks/sim_autopilot.hpp"

// Whatever it is told, the emulated autopilot stays a body of finite place and speed, and never flies
// disarmed. Input: records of a kind (index of the known messages, or raw bytes), a length and that many
// bytes; a good checksum is put round the former so that the fuzzer gets past the framing.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace forager;
  using namespace forager::mocks;
  MemoryStreamPair line("fuzz", MemoryStreamKind::datagrams);
  (void)line.near().open();
  (void)line.near().poll();
  SimAutopilotConfig config;
  config.origin_known = true;
  SimAutopilot sim(line.far(), config);
  MavlinkPeerPacker packer(1, 191);
  hal::Instant now(std::chrono::seconds(1));
  std::span<const std::uint8_t> rest(data, size);
  std::array<std::byte, 512> room{};
  for (int records = 0; rest.size() >= 2 && records < 200; ++records) {
    const std::size_t which = rest[0] % (peer::kKnown.size() + 1);
    const std::size_t length = std::min<std::size_t>(rest[1], rest.size() - 2);
    const auto body = std::as_bytes(rest.subspan(2, length));
    rest = rest.subspan(2 + length);
    if (which == peer::kKnown.size()) {
      (void)line.near().write(body);
    } else {
      MavlinkPayload payload;
      std::ranges::copy(body, payload.room().begin());
      (void)line.near().write(packer.pack(peer::kKnown[which], payload));
    }
    now += std::chrono::milliseconds(100);
    sim.update(now);
    for (auto count = line.near().read(room); count && *count != 0; count = line.near().read(room)) {
    }
    const BodyState& body_state = sim.state();
    const bool sane = hal::is_finite(body_state.pose.position) &&
                      hal::is_finite(body_state.velocity_world_m_s) &&
                      std::isfinite(body_state.pose.yaw_rad) &&
                      (sim.armed() || body_state.on_ground || body_state.velocity_world_m_s.z <= 2.0);
    if (!sane) std::abort();
  }
  return 0;
}
