// Any bytes as a recording. What is accepted is written and read back the same, and no content of a record
// does harm to the devices that answer from it.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "hal/recording.hpp"
#include "mocks/replay_bus.hpp"
#include "mocks/replay_digital.hpp"
#include "mocks/replay_http.hpp"
#include "mocks/replay_pwm.hpp"
#include "mocks/replay_sources.hpp"
#include "mocks/replay_stream.hpp"
#include "mocks/virtual_clock.hpp"

namespace {

namespace hal = forager::hal;
namespace mocks = forager::mocks;

void require(bool holds) {
  if (!holds) std::abort();
}

void ask_everything(std::vector<hal::Record> records) {
  mocks::VirtualClock clock(hal::Instant(hal::Duration(1'000'000'000)));
  const std::string device = records.empty() ? "a" : records.back().device;
  mocks::Replay replay(std::move(records), clock);
  std::array<std::byte, 16> room{};
  std::array<std::uint16_t, 2> words{};
  std::array<hal::Edge, 2> edges{};
  mocks::ReplayStream stream(device, replay);
  mocks::ReplayI2c i2c(device, replay);
  mocks::ReplayModbus modbus(device, replay);
  mocks::ReplayEdgeIn line(device, replay);
  mocks::ReplayHttpClient http(device, replay);
  mocks::ReplayPwmChannel channel(device, replay);
  mocks::ReplayPoseSource pose(device, replay);
  mocks::ReplayDepthSource depth(device, replay);
  for (int i = 0; i < 4; ++i) {
    const auto got = stream.read(room);
    require(!got || *got <= room.size());
    static_cast<void>(stream.poll());
    static_cast<void>(stream.write(std::span(room).first(1)));
    static_cast<void>(i2c.write_read(0x40, std::span(room).first(1), std::span(room).first(2)));
    static_cast<void>(modbus.read_holding(7, 10, words));
    static_cast<void>(line.active());
    static_cast<void>(line.edges(edges));
    static_cast<void>(http.poll(clock.now()));
    static_cast<void>(channel.release());
    static_cast<void>(pose.poll(clock.now()));
    const auto frame = depth.poll(clock.now());
    if (frame && *frame)
      std::visit(
          [&](const auto& pixels) {
            require(pixels.size() == static_cast<std::size_t>((**frame).camera.columns) *
                                         static_cast<std::size_t>((**frame).camera.rows));
          },
          (**frame).pixels);
    clock.advance(std::chrono::seconds(10));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto records = hal::parse_recording({reinterpret_cast<const char*>(data), size});
  if (!records) return 0;
  std::string text(hal::kRecordingHead);
  text += '\n';
  for (const hal::Record& record : *records) text += hal::to_line(record) + "\n";
  const auto again = hal::parse_recording(text);
  require(again && again->size() == records->size());
  for (std::size_t i = 0; i < records->size(); ++i)
    require(hal::to_line((*records)[i]) == hal::to_line((*again)[i]));
  ask_everything(*std::move(records));
  return 0;
}
