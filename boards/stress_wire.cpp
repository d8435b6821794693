// Check values, and numbers on their way over a wire.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "boards/stress_case.hpp"
#include "flight/mavlink/codec.hpp"
#include "flight/mavlink/crc.hpp"
#include "flight/mavlink/messages_motion.hpp"
#include "flight/mavlink/parser.hpp"
#include "hal/journal.hpp"
#include "hal/units.hpp"
#include "mocks/gen2_wire.hpp"
#include "mocks/rotation.hpp"
#include "mocks/sim_i2c_bus.hpp"
#include "mocks/sim_pca9685.hpp"
#include "mocks/truth_feed.hpp"
#include "servo/pca9685.hpp"

namespace forager::boards {
namespace {

namespace mavlink = flight::mavlink;
using namespace std::chrono_literals;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::string_view kDigits = "123456789";

mocks::Gen2Bits bits_of(std::string_view text) {
  mocks::Gen2Bits bits;
  for (const char c : text) bits.push(static_cast<unsigned char>(c), 8);
  return bits;
}

StressCase check_values() {
  Worst worst;
  const auto differ = [&](unsigned value, unsigned expected) {
    worst.near(double{1.0} * value, double{1.0} * expected);
  };
  differ(mavlink::crc_add(mavlink::kCrcStart, kDigits), 0x6F91);
  differ(mavlink::crc_add(mavlink::kCrcStart, std::string_view()), 0xFFFF);
  differ(mocks::gen2_crc16(bits_of(kDigits)), 0xD64E);
  differ(mocks::gen2_crc5(bits_of(kDigits)), 0x00);
  // A check value of 0 says little: a whole Query, over itself and its CRC, must leave 0, too.
  differ(mocks::gen2_crc5(mocks::encode_query({})), 0x00);
  return worst.against("crc: check values of MAVLink (6F91), Gen2 CRC-16 (D64E) and CRC-5 (00)", 0.0);
}

// CRC-16 over some bytes finds every flip of one, two and three bits, and two bytes that changed places.
StressCase flipped_bits() {
  Worst worst;
  std::array<std::byte, 16> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(37 * i + 11);
  const auto crc = [&] { return mavlink::crc_add(mavlink::kCrcStart, std::span<const std::byte>(bytes)); };
  const auto flip = [&](std::size_t bit) { bytes[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8)); };
  const auto whole = crc();
  double missed = 0.0;
  for (std::size_t a = 0; a < 8 * bytes.size(); ++a) {
    flip(a);
    if (crc() == whole) ++missed;
    for (std::size_t b = a + 1; b < 8 * bytes.size(); ++b) {
      flip(b);
      if (crc() == whole) ++missed;
      for (std::size_t c = b + 1; c < 8 * bytes.size(); c += 7) {
        flip(c);
        if (crc() == whole) ++missed;
        flip(c);
      }
      flip(b);
    }
    flip(a);
  }
  for (std::size_t i = 1; i < bytes.size(); ++i) {
    std::swap(bytes[i - 1], bytes[i]);
    if (crc() == whole) ++missed;
    std::swap(bytes[i - 1], bytes[i]);
  }
  worst.add(missed);
  return worst.against("crc: flips of 1 to 3 bits and swapped bytes that go unseen", 0.0);
}

// Not a number keeps its bits, minus zero its sign, and of a payload of zeros one byte is sent.
StressCase mavlink_floats() {
  Worst worst;
  mavlink::Sender sender;
  mavlink::FrameBuffer buffer;
  mavlink::Parser parser;
  const auto there_and_back = [&](const mavlink::Attitude& message) {
    mavlink::Attitude back;
    std::size_t frames = 0;
    parser.feed(mavlink::encode(message, sender, buffer), [&](const mavlink::Frame& frame) {
      back = mavlink::decode<mavlink::Attitude>(frame);
      ++frames;
    });
    worst.must(frames == 1);
    return back;
  };
  for (const std::uint32_t bits :
       {0x7FC00000U, 0x7F800001U, 0xFFFFFFFFU, 0x80000000U, 0x00000001U, 0x7F800000U}) {
    mavlink::Attitude message;
    message.pitch = std::bit_cast<float>(bits);
    message.time_boot_ms = 0xFFFFFFFFU;
    const mavlink::Attitude back = there_and_back(message);
    worst.must(std::bit_cast<std::uint32_t>(back.pitch) == bits && back.time_boot_ms == 0xFFFFFFFFU);
  }
  there_and_back({});
  worst.must(buffer.size() == mavlink::kHeaderV2 + 1 + 2);
  return worst.against("mavlink: NaN with its bits, -0, denormals, all zeros over the wire", 0.0);
}

// Attitudes as quaternions and back, straight up and down included; q and -q are one, a shorter q is scaled.
StressCase quaternions() {
  Worst worst;
  const auto turn = [](const hal::Pose& a, const hal::Pose& b) {
    double off = 0.0;
    for (const hal::Vec3 axis : {hal::Vec3{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}})
      off = std::max(off, hal::norm(mocks::axes_of(a).to_parent(axis) - mocks::axes_of(b).to_parent(axis)));
    return off;
  };
  for (const double yaw : evenly(-180.0, 180.0, 22.5))
    for (const double pitch : {-90.0, -89.9999, -45.0, 0.0, 30.0, 89.9999, 90.0})
      for (const double roll : {-180.0, -90.0, 0.0, 1e-6, 135.0, 180.0}) {
        mocks::BodyState body;
        body.pose = {{1.0, -2.0, 3.0}, hal::deg_to_rad(yaw), hal::deg_to_rad(pitch), hal::deg_to_rad(roll)};
        mocks::MavlinkPayload payload = mocks::encode_truth(body, {});
        for (const double scale : {1.0, -1.0, 1.0005}) {
          mocks::MavlinkPayload scaled = payload;
          for (const std::size_t at : {20U, 24U, 28U, 32U}) scaled.f32(at, scale * payload.f32(at));
          const auto back = mocks::decode_truth(scaled);
          worst.add(back ? turn(back->pose, body.pose) : kNaN);
        }
      }
  // Next to +-90 degrees the last bit of a float is 5e-4 rad of pitch, and yaw and roll are one angle.
  return worst.against("quaternions: attitudes as floats and back, 90 degrees up and down, q and -q", 2e-3);
}

StressCase quaternions_that_are_none() {
  Worst worst;
  const mocks::MavlinkPayload good = mocks::encode_truth({}, {});
  for (const double w : {0.0, 0.5, 2.0, 1e30, kNaN, HUGE_VAL}) {
    mocks::MavlinkPayload bad = good;
    bad.f32(20, w);
    worst.must(!mocks::decode_truth(bad));
  }
  return worst.against("quaternions: zero, NaN, infinite and far from length 1: refused", 0.0);
}

// Ticks from the chip's true period, not from the one asked for: half a tick at most.
StressCase pulses_of_the_pca9685() {
  Worst worst;
  for (const double rate_hz : {50.0, 100.0, 200.0, 333.0, 400.0, 490.0}) {
    mocks::SimPca9685 chip_side;
    mocks::SimI2cBus bus("i2c");
    bus.attach(0x40, chip_side);
    hal::NullJournal journal;
    servo::Pca9685 chip(bus, nullptr, journal, {.period = hal::from_seconds(1.0 / rate_hz)});
    hal::Instant now{};
    worst.must(chip.open(now).has_value());
    for (int i = 0; i < 5; ++i) {
      now += 1ms;
      chip_side.advance(now);
      worst.must(chip.update(now).has_value());
    }
    const double tick_us = 1e-3 * static_cast<double>(chip_side.period().count()) / 4096.0;
    for (const double pulse_us : evenly(900.0, 1900.0, 13.7)) {
      worst.must(chip.channel(3).set_pulse(hal::from_seconds(pulse_us * 1e-6)).has_value());
      const auto made = chip_side.pulse(3);
      // In half ticks; what integer nanoseconds round comes on top.
      worst.add(made ? (std::abs(1e-3 * static_cast<double>(made->count()) - pulse_us) - 2e-3) /
                           (0.5 * tick_us)
                     : kNaN);
    }
  }
  return worst.against("pca9685: pulses at 50 to 490 Hz, off in half ticks", 1.0);
}

}  // namespace

std::vector<StressCase> stress_wire() {
  return {
      check_values(),         flipped_bits(), mavlink_floats(), quaternions(), quaternions_that_are_none(),
      pulses_of_the_pca9685()};
}

}  // namespace forager::boards
