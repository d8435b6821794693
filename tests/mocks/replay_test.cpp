#include "mocks/replay.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <optional>

#include "hal/hid.hpp"
#include "hal/usb.hpp"
#include "mocks/fake_depth_source.hpp"
#include "mocks/fake_digital_in.hpp"
#include "mocks/fake_digital_out.hpp"
#include "mocks/fake_hid.hpp"
#include "mocks/fake_modbus.hpp"
#include "mocks/fake_pose_source.hpp"
#include "mocks/fake_pwm.hpp"
#include "mocks/fake_usb.hpp"
#include "mocks/memory_stream.hpp"
#include "mocks/recording_bus.hpp"
#include "mocks/recording_digital.hpp"
#include "mocks/recording_hid.hpp"
#include "mocks/recording_http.hpp"
#include "mocks/recording_pwm.hpp"
#include "mocks/recording_sources.hpp"
#include "mocks/recording_stream.hpp"
#include "mocks/recording_usb.hpp"
#include "mocks/replay_bus.hpp"
#include "mocks/replay_digital.hpp"
#include "mocks/replay_hid.hpp"
#include "mocks/replay_http.hpp"
#include "mocks/replay_pwm.hpp"
#include "mocks/replay_sources.hpp"
#include "mocks/replay_stream.hpp"
#include "mocks/replay_usb.hpp"
#include "mocks/scripted_http_client.hpp"
#include "mocks/sim_hid_echo.hpp"
#include "mocks/sim_i2c_bus.hpp"
#include "mocks/sim_pca9685.hpp"
#include "mocks/sim_usb_echo.hpp"
#include "mocks/virtual_clock.hpp"

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

const hal::Error kBroken{hal::ErrorCode::io, "device", "call", "injected", "mend it", 5};

// What a driver saw, as text: two equal ones saw the same, errors and their words included.
class Seen {
 public:
  void add(const hal::Result<>& answer) { text_ += (answer ? "done" : hal::describe(answer.error())) + "\n"; }
  template <class Value>
  void add(const hal::Result<Value>& answer) {
    text_ += (answer ? fmt::format("{}", *answer) : hal::describe(answer.error())) + "\n";
  }
  void add(std::string_view text) { text_ += std::string(text) + "\n"; }
  void add(std::span<const std::byte> bytes) { add(hal::field(bytes)); }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// `driver` drives a device by the clock it is given; afterwards the same driver, much later, gets the
// recording.
class ReplayTest : public testing::Test {
 protected:
  Replay& replay() {
    auto records = hal::parse_recording(text_);
    EXPECT_TRUE(records) << (records ? "" : describe(records.error()));
    return replay_.emplace(*std::move(records), later_);
  }
  void expect_same() {
    EXPECT_EQ(live_.text(), replayed_.text());
    EXPECT_EQ(0U, replay_->calls_left());
    EXPECT_THAT(live_.text(), HasSubstr("injected")) << "an error is part of it";
  }
  VirtualClock clock_{hal::Instant(5s)};
  VirtualClock later_{hal::Instant(1000s)};
  std::string text_;
  hal::Recorder recorder_{clock_, [this](std::string_view line) { text_ += line; }};
  std::optional<Replay> replay_;
  Seen live_;
  Seen replayed_;
};

void drive_lines(hal::EdgeIn& in, hal::DigitalOut& out, hal::DigitalOutGroup& both, VirtualClock& clock,
                 Seen& seen, const std::function<void(int)>& world) {
  const hal::Instant start = clock.now();
  std::array<hal::Edge, 4> edges{};
  for (int step = 0; step < 6; ++step) {
    world(step);
    seen.add(in.active());
    const auto count = in.edges(edges);
    seen.add(count);
    for (std::size_t i = 0; count && i < *count; ++i)
      seen.add(fmt::format("{} {}", (edges[i].at - start).count(), edges[i].active));
    seen.add(out.set(step % 2 == 0));
    seen.add(both.set(std::array{step > 2, step > 4}));
    clock.advance(20ms);
  }
}

class FakeGroup final : public hal::DigitalOutGroup {
  hal::Result<> do_set(std::span<const bool> active) override {
    return active[1] ? hal::Result<>(hal::fail(kBroken)) : hal::Result<>();
  }
  [[nodiscard]] std::size_t do_size() const override { return 2; }
  [[nodiscard]] std::string_view do_name() const override { return "both"; }
};

TEST_F(ReplayTest, Lines) {
  FakeDigitalIn in("stop");
  FakeDigitalOut out("lamp");
  FakeGroup group;
  RecordingEdgeIn recorded_in(in, recorder_);
  RecordingDigitalOut recorded_out(out, recorder_);
  RecordingDigitalOutGroup recorded_group(group, recorder_);
  drive_lines(recorded_in, recorded_out, recorded_group, clock_, live_, [&](int step) {
    in.drive(step == 2 || step == 3, clock_.now());
    if (step == 4) in.fail_next(kBroken);
    if (step == 1) out.fail_next(kBroken);
  });
  ReplayEdgeIn again_in("stop", replay());
  ReplayDigitalOut again_out("lamp", *replay_);
  ReplayDigitalOutGroup again_group("both", 2, *replay_);
  drive_lines(again_in, again_out, again_group, later_, replayed_, [](int) {});
  expect_same();
}

void drive_pwm(hal::PwmChannel& channel, hal::PwmGroup& group, VirtualClock& clock, Seen& seen,
               const std::function<void(int)>& world) {
  const auto pulse = [&] {
    const auto now = channel.pulse();
    seen.add(now ? fmt::format("pulse {}", now->count()) : "released");
  };
  for (int step = 0; step < 4; ++step) {
    world(step);
    pulse();
    seen.add(channel.set_pulse(1ms + step * 100us));
    pulse();
    clock.advance(20ms);
  }
  seen.add(group.set_period(3ms));
  seen.add(group.set_period(1ms));  // shorter than the pulse
  seen.add(fmt::format("{}", group.period().count()));
  seen.add(channel.release());
  pulse();
}

TEST_F(ReplayTest, Pulses) {
  FakePwmGroup group("timer", 1);
  FakePwmChannel& channel = group.channel(0);
  RecordingPwmChannel recorded(channel, recorder_);
  RecordingPwmGroup recorded_group(group, recorder_);
  drive_pwm(recorded, recorded_group, clock_, live_, [&](int step) {
    if (step == 2) channel.fail_next(kBroken);
  });
  ReplayPwmChannel again(std::string(channel.name()), replay());
  ReplayPwmGroup again_group("timer", *replay_);
  drive_pwm(again, again_group, later_, replayed_, [](int) {});
  expect_same();
}

void drive_buses(hal::I2c& i2c, hal::Modbus& modbus, Seen& seen, const std::function<void(int)>& world) {
  std::array<std::byte, 2> two{};
  std::array<std::uint16_t, 2> words{};
  for (int step = 0; step < 3; ++step) {
    world(step);
    seen.add(i2c.write(0x40, std::array{std::byte{6}, static_cast<std::byte>(step)}));
    seen.add(i2c.write_read(0x40, std::array{std::byte{6}}, two));
    seen.add(std::span<const std::byte>(two));
    seen.add(i2c.read(0x41, two));
    seen.add(modbus.write_holding(3, 10, std::array<std::uint16_t, 2>{7, static_cast<std::uint16_t>(step)}));
    seen.add(modbus.read_holding(3, 10, words));
    seen.add(fmt::format("{} {}", words[0], words[1]));
    seen.add(modbus.read_input(3, 10, words));
    seen.add(modbus.write_coil(3, 1, step == 1));
  }
}

TEST_F(ReplayTest, Buses) {
  SimI2cBus i2c("wires");
  SimPca9685 chip;
  i2c.attach(0x40, chip);
  FakeModbus modbus(3);
  modbus.holding = {{10, 0}, {11, 0}};
  modbus.coils[1] = false;
  RecordingI2c recorded_i2c(i2c, recorder_);
  RecordingModbus recorded_modbus(modbus, recorder_);
  drive_buses(recorded_i2c, recorded_modbus, live_, [&](int step) {
    if (step == 1) modbus.fail_next(kBroken);
  });
  ReplayI2c again_i2c("wires", replay());
  ReplayModbus again_modbus("modbus fake", *replay_);
  drive_buses(again_i2c, again_modbus, replayed_, [](int) {});
  expect_same();
}

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

TEST_F(ReplayTest, Streams) {
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

TEST_F(ReplayTest, Requests) {
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

TEST_F(ReplayTest, Sources) {
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

TEST_F(ReplayTest, HidReports) {
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

TEST_F(ReplayTest, UsbTransfers) {
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

TEST_F(ReplayTest, ADriverThatDoesSomethingElseIsToldWhat) {
  FakeDigitalOut out("lamp");
  RecordingDigitalOut recorded(out, recorder_);
  clock_.advance(1500ms);
  ASSERT_TRUE(recorded.set(true));
  ReplayDigitalOut again("lamp", replay());
  const auto other = again.set(false);
  ASSERT_FALSE(other);
  EXPECT_EQ(hal::ErrorCode::protocol, other.error().code);
  EXPECT_THAT(describe(other.error()),
              HasSubstr("lamp: set 0: the recording has \"set 1\" here, at 6.500 s"));
  EXPECT_EQ(1U, replay_->calls_left());
  EXPECT_TRUE(again.set(true));
  EXPECT_EQ(hal::ErrorCode::invalid_state, again.set(true).error().code);
  ReplayDigitalOut unknown("horn", *replay_);
  EXPECT_THAT(describe(unknown.set(true).error()), HasSubstr("no more calls of this device"));
}

TEST_F(ReplayTest, FieldsOfAnotherKindAreRefusedAndNotBelieved) {
  text_ +=
      "5.000000000 line <bytes = ok 0x\n5.000000000 wires transfer 64 06 2 = ok 1e\n"
      "5.000000000 camera <frame = ok 0 99999999 99999999 1 1 1 1 1 1 m 00\n"
      "5.000000000 vslam <pose = ok 0 1 2\n";
  std::array<std::byte, 8> room{};
  std::array<std::byte, 2> two{};
  ReplayStream stream("line", replay());
  EXPECT_EQ(hal::ErrorCode::protocol, stream.read(room).error().code);
  ReplayI2c wires("wires", *replay_);
  EXPECT_EQ(hal::ErrorCode::protocol, wires.write_read(0x40, std::array{std::byte{6}}, two).error().code);
  EXPECT_EQ(hal::ErrorCode::protocol, ReplayDepthSource("camera", *replay_).poll(later_.now()).error().code);
  EXPECT_EQ(hal::ErrorCode::protocol, ReplayPoseSource("vslam", *replay_).poll(later_.now()).error().code);
}

}  // namespace
}  // namespace forager::mocks
