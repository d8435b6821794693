#include <fmt/format.h>

#include <optional>
#include <utility>

#include "boards/emulate.hpp"
#include "boards/world_builder.hpp"
#include "hal/linux/pseudo_terminal.hpp"
#include "hal/linux/udp_peer.hpp"
#include "hal/units.hpp"
#include "mocks/sim_autopilot.hpp"
#include "mocks/truth_feed.hpp"

namespace forager::boards {
namespace {

constexpr hal::Duration kTruthInterval = std::chrono::milliseconds(20);
constexpr hal::Duration kLongestStep = std::chrono::milliseconds(200);

class AutopilotServer final : public EmulatedServer {
 public:
  AutopilotServer(const Scene& scene, const EmulatedAutopilotOptions& options,
                  std::unique_ptr<hal::ByteStream> line, std::uint16_t port, hal::Journal& journal)
      : options_(options),
        world_(build_world(scene, options.seed)),
        line_(std::move(line)),
        port_(port),
        autopilot_(*line_, autopilot_config(scene, options.seed)) {
    autopilot_.attach(&world_, &journal);
    autopilot_.set_battery_fraction(scene.vehicle.battery_start);
    autopilot_.faults().refuse_arming = options.refuse_arming;
    for (const Endpoint& listener : options.truth) {
      listeners_.push_back(hal::open_udp_peer(listener.host, listener.port));
      feeds_.push_back(std::make_unique<mocks::TruthFeed>(autopilot_, *listeners_.back(), kTruthInterval));
    }
  }

  void update(hal::Instant now) override {
    now = without_stalls(now);
    autopilot_.update(now);
    for (auto& feed : feeds_) feed->update(now);
  }

  std::vector<NamedEndpoint> endpoints() const override {
    if (!options_.serial.empty()) return {};
    return {{"mavlink", {options_.listen.host, port_}}};
  }

  std::string address() const override {
    if (!options_.serial.empty()) return "MAVLink 2 on the serial port " + options_.serial;
    return fmt::format("MAVLink 2 on udp {}:{}", options_.listen.host, port_);
  }

  std::string status() const override {
    const mocks::BodyState& body = autopilot_.state();
    return fmt::format("{} {} at x {:.2f} y {:.2f} z {:.2f} m, heading {:.0f} deg, battery {:.0f} %",
                       body.armed ? "armed" : "disarmed", body.on_ground ? "on the ground" : "in the air",
                       body.pose.position.x, body.pose.position.y, body.pose.position.z,
                       hal::rad_to_deg(body.pose.yaw_rad), 100.0 * autopilot_.vehicle().battery_fraction());
  }

 private:
  // A flight controller never stands still, but this process may, on a busy machine. It must not then fly
  // seconds at once, blind to what waits in its socket: its time stands still as well.
  hal::Instant without_stalls(hal::Instant now) {
    if (last_ && now - *last_ > kLongestStep) stalled_ += now - *last_ - kLongestStep;
    last_ = now;
    return now - stalled_;
  }

  EmulatedAutopilotOptions options_;
  std::optional<hal::Instant> last_;
  hal::Duration stalled_{};
  mocks::World world_;
  std::unique_ptr<hal::ByteStream> line_;
  std::uint16_t port_;
  mocks::SimAutopilot autopilot_;
  std::vector<std::unique_ptr<hal::UdpPeer>> listeners_;
  std::vector<std::unique_ptr<mocks::TruthFeed>> feeds_;
};

}  // namespace

hal::Result<std::unique_ptr<EmulatedServer>> emulate_autopilot(const Scene& scene,
                                                               const EmulatedAutopilotOptions& options,
                                                               hal::Journal& journal) {
  if (!options.serial.empty()) {
    auto terminal = hal::open_pseudo_terminal(options.serial);
    if (!terminal) return hal::fail(std::move(terminal).error());
    return std::make_unique<AutopilotServer>(scene, options, *std::move(terminal), 0, journal);
  }
  auto line = hal::open_udp_listener(options.listen.host, options.listen.port);
  FORAGER_TRY(line->open());
  const std::uint16_t port = line->local_port();
  return std::make_unique<AutopilotServer>(scene, options, std::move(line), port, journal);
}

}  // namespace forager::boards
