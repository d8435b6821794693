#include "boards/mavlink_bench.hpp"

#include <utility>

#include "boards/autopilot_line.hpp"
#include "boards/device_set.hpp"
#include "hal/linux/serial_port.hpp"
#include "hal/linux/udp_peer.hpp"

namespace forager::boards {
namespace {

class RealLine final : public MavlinkBench {
 public:
  RealLine(std::unique_ptr<hal::ByteStream> line, bool serial) : line_(std::move(line)), serial_(serial) {}
  hal::ByteStream& line() override { return *line_; }
  void advance(hal::Instant /*now*/) override {}
  bool serial() const override { return serial_; }

 private:
  std::unique_ptr<hal::ByteStream> line_;
  bool serial_;
};

class EmulatedLine final : public MavlinkBench {
 public:
  explicit EmulatedLine(std::unique_ptr<DeviceSet> devices) : devices_(std::move(devices)) {}
  hal::ByteStream& line() override { return devices_->autopilot(); }
  void advance(hal::Instant now) override { devices_->advance(now); }
  bool serial() const override { return false; }

 private:
  std::unique_ptr<DeviceSet> devices_;
};

}  // namespace

hal::Result<std::unique_ptr<MavlinkBench>> open_mavlink_bench(const Board& board, const Scene& scene,
                                                              const MavlinkPlace& place,
                                                              const hal::Clock& clock, std::uint64_t seed) {
  if (!place.serial.empty()) {
    hal::SerialPortConfig config;
    config.device = place.serial;
    config.line.baud = place.baud;
    return std::make_unique<RealLine>(hal::open_serial_port(config, clock), true);
  }
  if (!place.listen.empty()) {
    const auto at = endpoint_from(place.listen);
    if (!at) return hal::fail(at.error());
    return std::make_unique<RealLine>(hal::open_udp_listener(at->host, at->port), false);
  }
  if (board.kind == BoardKind::sim) {
    auto devices = make_sim_devices(scene, {.seed = seed});
    if (!devices) return hal::fail(std::move(devices).error());
    return std::make_unique<EmulatedLine>(*std::move(devices));
  }
  return std::make_unique<RealLine>(open_autopilot_line(board), !board.autopilot_serial.empty());
}

}  // namespace forager::boards
