// Lines, pulses and buses: what a driver saw of the recorded device it sees again.
#include "mocks/replay.hpp"

#include <array>
#include <functional>

#include "mocks/fake_digital_in.hpp"
#include "mocks/fake_digital_out.hpp"
#include "mocks/fake_modbus.hpp"
#include "mocks/fake_pwm.hpp"
#include "mocks/recording_bus.hpp"
#include "mocks/recording_digital.hpp"
#include "mocks/recording_pwm.hpp"
#include "mocks/replay_bus.hpp"
#include "mocks/replay_digital.hpp"
#include "mocks/replay_pwm.hpp"
#include "mocks/replay_sources.hpp"
#include "mocks/replay_stream.hpp"
#include "mocks/sim_i2c_bus.hpp"
#include "mocks/sim_pca9685.hpp"
#include "tests/mocks/replay_rig.hpp"

namespace forager::mocks {
namespace {

using namespace test;

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
