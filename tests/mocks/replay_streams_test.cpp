// Streams, requests, sources and plugs: what a driver saw of the recorded device it sees again.
#include <array>
#include <functional>

#include "hal/hid.hpp"
#include "hal/usb.hpp"
#include "mocks/fake_depth_source.hpp"
#include "mocks/fake_hid.hpp"
#include "mocks/fake_pose_source.hpp"
#include "mocks/fake_usb.hpp"
#include "mocks/memory_stream.hpp"
#include "mocks/recording_hid.hpp"
#include "mocks/recording_http.hpp"
#include "mocks/recording_sources.hpp"
#include "mocks/recording_stream.hpp"
#include "mocks/recording_usb.hpp"
#include "mocks/replay_hid.hpp"
#include "mocks/replay_http.hpp"
#include "mocks/replay_sources.hpp"
#include "mocks/replay_stream.hpp"
#include "mocks/replay_usb.hpp"
#include "mocks/scripted_http_client.hpp"
#include "mocks/sim_hid_echo.hpp"
#include "mocks/sim_usb_echo.hpp"
#include "tests/mocks/replay_rig.hpp"

namespace forager::mocks {
namespace {

using namespace test;

class ReplayStreamsTest : public ReplayTest {};

void drive_stream(hal::ByteStream& stream, VirtualClock& clock, Seen& seen,
                  const std::function<void(int)>& world) {
  std::array<std::byte, 8> room{};
  for (int step = 0; step < 8; ++step) {
    world(step);
    const auto state = stream.poll();
    seen.add(state ? fmt::format("state {}", static_cast<int>(*state)) : describe(state.error()));
    if (state && *state == hal::StreamState::closed) seen.add(stream.open());
    if (state && *state == hal::StreamState::open) {
      seen.add(stream.write(std::array{std::byte{0x10}, static_cast<std::byte>(step)}));
      const auto count = stream.read(room);
      seen.add(count);
      if (count) seen.add(std::span<const std::byte>(room).first(*count));
      if (step == 6) stream.close();
    }
    clock.advance(10ms);
  }
}

TEST_F(ReplayStreamsTest, Streams) {
  MemoryStreamPair line("line", MemoryStreamKind::bytes);
  RecordingStream recorded(line.near(), recorder_);
  drive_stream(recorded, clock_, live_, [&](int step) {
    if (step == 2) static_cast<void>(line.far().write(std::array{std::byte{1}, std::byte{2}, std::byte{3}}));
    if (step == 3) line.near().fail_next(kBroken);
  });
  ReplayStream again(std::string(line.near().name()), replay());
  drive_stream(again, later_, replayed_, [](int) {});
  expect_same();
}

void drive_http(hal::HttpClient& client, VirtualClock& clock, Seen& seen) {
  for (const char* path : {"/devices", "/start", "/gone"}) {
    hal::HttpRequest request;
    request.method = path[1] == 's' ? hal::HttpMethod::put : hal::HttpMethod::get;
    request.path = path;
    request.body = "a body with = and\nlines";
    request.timeout = 1s;
    seen.add(client.start(request, clock.now()));
    for (int i = 0; i < 4; ++i) {
      const auto answer = client.poll(clock.now());
      seen.add(!answer   ? describe(answer.error())
               : *answer ? std::to_string((**answer).status) + (**answer).body
                         : "waits");
      if (!answer || *answer) break;
      clock.advance(30ms);
    }
  }
}

TEST_F(ReplayStreamsTest, Requests) {
  ScriptedHttpClient client("http reader");
  client.latency(50ms)
      .expect(hal::HttpMethod::get, "/devices")
      .answer(200, "<xml/>")
      .expect(hal::HttpMethod::put, "/start")
      .answer(500, "")
      .expect(hal::HttpMethod::get, "/gone")
      .fail(kBroken);
  RecordingHttpClient recorded(client, recorder_);
  drive_http(recorded, clock_, live_);
  ReplayHttpClient again("http reader", replay());
  drive_http(again, later_, replayed_);
  expect_same();
}

void drive_sources(hal::PoseSource& pose, hal::DepthSource& depth, VirtualClock& clock, Seen& seen,
                   const std::function<void(int)>& world) {
  const hal::Instant start = clock.now();
  for (int step = 0; step < 5; ++step) {
    world(step);
    const auto sample = pose.poll(clock.now());
    if (!sample) seen.add(describe(sample.error()));
    if (sample && *sample)
      seen.add(fmt::format("{} {} {} {}", ((**sample).stamp - start).count(), (**sample).pose.position.x,
                           (**sample).pose.yaw_rad, (**sample).reset_counter));
    const auto frame = depth.poll(clock.now());
    if (!frame) seen.add(describe(frame.error()));
    if (frame && *frame) {
      seen.add(fmt::format("{} {} {} {}", ((**frame).stamp - start).count(), (**frame).camera.columns,
                           (**frame).camera.fx_px, (**frame).pixels.index()));
      std::visit([&](const auto& pixels) { seen.add(std::as_bytes(pixels)); }, (**frame).pixels);
    }
    clock.advance(33ms);
  }
}

TEST_F(ReplayStreamsTest, Sources) {
  FakePoseSource pose;
  FakeDepthSource depth;
  RecordingPoseSource recorded_pose(pose, "vslam", recorder_);
  RecordingDepthSource recorded_depth(depth, "camera", recorder_);
  hal::DepthCameraModel camera;
  camera.columns = 2;
  camera.rows = 1;
  camera.fx_px = 0.1;
  const std::array<std::uint16_t, 2> millimetres{1200, 65535};
  drive_sources(recorded_pose, recorded_depth, clock_, live_, [&](int step) {
    hal::PoseSample sample;
    sample.stamp = clock_.now() - 3ms;
    sample.pose.position.x = 1.0 / 3.0;
    sample.pose.yaw_rad = -0.1 * step;
    sample.reset_counter = 200;
    if (step != 1) pose.show(sample);
    if (step == 3) pose.fail_next(kBroken);
    if (step == 0) depth.show_wall(clock_.now(), camera, 2.5F);
    if (step == 2) depth.show({clock_.now(), camera, std::span<const std::uint16_t>(millimetres)});
  });
  ReplayPoseSource again_pose("vslam", replay());
  ReplayDepthSource again_depth("camera", *replay_);
  drive_sources(again_pose, again_depth, later_, replayed_, [](int) {});
  expect_same();
}

void drive_hid(hal::HidDevice& device, Seen& seen, const std::function<void(int)>& world) {
  std::array<std::byte, 65> room{};
  std::array<std::byte, 9> feature{};
  for (int step = 0; step < 3; ++step) {
    world(step);
    std::array<std::byte, 65> out{};
    out[1] = static_cast<std::byte>(step);
    seen.add(device.write(out));
    const auto size = step == 1 ? device.read(room, 100ms) : device.poll(room);
    seen.add(size);
    if (size) seen.add(std::span<const std::byte>(room).first(*size));
    feature[0] = std::byte{0};
    seen.add(device.get_feature(feature));
    seen.add(device.read(room, 10ms));  // nothing more
    feature[1] = static_cast<std::byte>(step);
    seen.add(device.send_feature(feature));
  }
}

TEST_F(ReplayStreamsTest, HidReports) {
  SimHidEcho echo;
  FakeHid hid;
  hid.plug(echo);
  const auto device = hid.open({}, hal::HidSharing::shared).value();
  RecordingHidDevice recorded(*device, recorder_);
  drive_hid(recorded, live_, [&](int step) {
    if (step == 2) hid.fail_next(echo, kBroken);
  });
  ReplayHidDevice again(device->facts(), replay());
  drive_hid(again, replayed_, [](int) {});
  expect_same();
}

void drive_usb(hal::UsbDevice& device, VirtualClock& clock, Seen& seen,
               const std::function<void(int)>& world) {
  std::array<std::byte, 64> room{};
  const std::array bytes{std::byte{1}, std::byte{2}};
  seen.add(device.bulk_out(1, bytes, 1s));  // not claimed
  seen.add(device.claim(0));
  for (int step = 0; step < 3; ++step) {
    world(step);
    seen.add(device.control_out({.request = 0x43}, bytes, 1s));
    const auto memory = device.control_in({.request = 0x42}, room, 1s);
    seen.add(memory);
    if (memory) seen.add(std::span<const std::byte>(room).first(*memory));
    seen.add(device.bulk_out(1, bytes, 1s));
    seen.add(device.bulk_in(0x81, room, 1s));
  }
  seen.add(device.start(1, {}));
  seen.add(device.start(0x81, {.bytes = 64, .transfers = 2}));
  seen.add(device.push_out(1, bytes));
  seen.add(device.drain(1, 1s));
  for (int i = 0; i < 5; ++i) {
    const auto size = device.poll_in(0x81, room);
    if (!size) seen.add(describe(size.error()));
    if (size && *size) seen.add(std::span<const std::byte>(room).first(**size));
    clock.advance(1ms);
  }
  device.stop(0x81);
  device.stop(1);
  seen.add(device.clear_halt(0x81));
  seen.add(device.release(0));
}

TEST_F(ReplayStreamsTest, UsbTransfers) {
  SimUsbEcho echo;
  FakeUsb usb;
  usb.plug(echo);
  const auto device = usb.open({}).value();
  RecordingUsbDevice recorded(*device, recorder_);
  drive_usb(recorded, clock_, live_, [&](int step) {
    if (step == 1) usb.fail_next(echo, kBroken);
  });
  ReplayUsbDevice again(device->facts(), replay());
  drive_usb(again, later_, replayed_, [](int) {});
  expect_same();
}

}  // namespace
}  // namespace forager::mocks
