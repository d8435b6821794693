#include "hal/mcp2221.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "mocks/fake_hid.hpp"
#include "mocks/sim_hid_echo.hpp"
#include "mocks/sim_i2c_bus.hpp"
#include "mocks/sim_mcp2221.hpp"
#include "mocks/sim_pca9685.hpp"

namespace forager::hal {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

// A chip with a memory of 256 bytes behind one pointer, as an EEPROM.
class Memory final : public mocks::SimI2cDevice {
 public:
  std::array<std::byte, 256> bytes{};
  std::uint8_t pointer = 0;
  std::optional<std::uint8_t> refuses;  // to be written there

  void start() override { first_ = true; }
  bool write(std::byte byte) override {
    if (std::exchange(first_, false)) {
      pointer = std::to_integer<std::uint8_t>(byte);
      return true;
    }
    if (refuses == pointer) return false;
    bytes.at(pointer++) = byte;
    return true;
  }
  std::optional<std::byte> read() override { return bytes.at(pointer++); }

 private:
  bool first_ = true;
};

class Mcp2221Test : public testing::Test {
 protected:
  Mcp2221Test() {
    wires_.attach(0x50, memory_);
    hid_.plug(chip_);
    auto opened = Mcp2221::open(hid_, {});
    EXPECT_TRUE(opened.has_value()) << (opened ? "" : describe(opened.error()));
    bridge_ = *std::move(opened);
  }
  ~Mcp2221Test() override { EXPECT_THAT(chip_.violations(), testing::IsEmpty()); }
  Mcp2221Test(const Mcp2221Test&) = delete;
  Mcp2221Test& operator=(const Mcp2221Test&) = delete;

  static std::vector<std::byte> pattern(std::size_t count) {
    std::vector<std::byte> bytes(count);
    for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::byte>(i * 13 + 5);
    return bytes;
  }
  I2c& i2c() { return bridge_->i2c(); }

  Memory memory_;
  mocks::SimI2cBus wires_{"wires"};
  mocks::SimMcp2221 chip_{wires_};
  mocks::FakeHid hid_;
  std::unique_ptr<Mcp2221> bridge_;
};

TEST_F(Mcp2221Test, SaysWhoItIsAndRunsTheBusAsAsked) {
  EXPECT_EQ("mcp2221 SN0001", bridge_->name());
  EXPECT_EQ("hardware A6, firmware 12", bridge_->version());
  EXPECT_EQ(100'000U, chip_.i2c_hz());
  bridge_.reset();
  bridge_ = Mcp2221::open(hid_, {.i2c_hz = 350'000}).value();
  EXPECT_LE(chip_.i2c_hz(), 350'000U);
  EXPECT_GE(chip_.i2c_hz(), 335'000U);
  EXPECT_EQ(ErrorCode::invalid_argument, Mcp2221::open(hid_, {.i2c_hz = 1'000'000}).error().code);
}

TEST_F(Mcp2221Test, WritesAndReadsOfAnyLengthArriveWhole) {
  for (const std::size_t count :
       {std::size_t{1}, std::size_t{59}, std::size_t{60}, std::size_t{61}, std::size_t{200}}) {
    const auto bytes = pattern(count);
    std::vector<std::byte> sent{std::byte{7}};
    sent.insert(sent.end(), bytes.begin(), bytes.end());
    ASSERT_TRUE(i2c().write(0x50, sent).has_value()) << count;
    std::vector<std::byte> got(count);
    const auto pointer = std::array{std::byte{7}};
    ASSERT_TRUE(i2c().write_read(0x50, pointer, got).has_value()) << count;
    EXPECT_EQ(bytes, got);
    ASSERT_TRUE(i2c().write(0x50, pointer).has_value());
    std::vector<std::byte> again(count);
    ASSERT_TRUE(i2c().read(0x50, again).has_value()) << count;
    EXPECT_EQ(bytes, again);
  }
}

TEST_F(Mcp2221Test, ASlowBusIsWaitedForAndNotForEver) {
  chip_.set_slowness(20);
  const auto bytes = pattern(8);
  ASSERT_TRUE(i2c().write(0x50, bytes).has_value());
  std::vector<std::byte> got(4);
  ASSERT_TRUE(i2c().write_read(0x50, std::span(bytes).first(1), got).has_value());
  chip_.set_slowness(10'000);
  const auto stuck = i2c().write(0x50, bytes);
  ASSERT_FALSE(stuck.has_value());
  EXPECT_EQ(ErrorCode::timeout, stuck.error().code);
  chip_.set_slowness(1);
  EXPECT_TRUE(i2c().write(0x50, bytes).has_value()) << "the engine was told to let go";
}

TEST_F(Mcp2221Test, WhoDoesNotAcknowledgeIsNamedAndTheBusGoesOn) {
  const auto bytes = pattern(4);
  std::vector<std::byte> room(4);
  for (const auto& nobody :
       {i2c().write(0x51, bytes), i2c().read(0x51, room), i2c().write_read(0x51, bytes, room)}) {
    ASSERT_FALSE(nobody.has_value());
    EXPECT_EQ(ErrorCode::no_ack, nobody.error().code);
    EXPECT_THAT(describe(nobody.error()), HasSubstr("i2c mcp2221 SN0001: transfer with 0x51"));
    EXPECT_TRUE(i2c().write(0x50, bytes).has_value());
  }
  memory_.refuses = 9;
  const std::array<std::byte, 3> refused{std::byte{8}, std::byte{1}, std::byte{2}};
  EXPECT_EQ(ErrorCode::no_ack, i2c().write(0x50, refused).error().code);
  EXPECT_EQ(ErrorCode::invalid_argument, i2c().write(0x03, bytes).error().code);
}

TEST_F(Mcp2221Test, ABusHeldLowIsATimeout) {
  chip_.hold_bus(true);
  const auto held = i2c().write(0x50, pattern(2));
  ASSERT_FALSE(held.has_value());
  EXPECT_EQ(ErrorCode::timeout, held.error().code);
  EXPECT_THAT(held.error().mend, HasSubstr("SCL or SDA"));
  chip_.hold_bus(false);
  EXPECT_TRUE(i2c().write(0x50, pattern(2)).has_value());
}

TEST_F(Mcp2221Test, OutputsBeginInactiveAndFollow) {
  auto plain = bridge_->output({.number = 0}).value();
  auto low = bridge_->output({.number = 3, .active_low = true}).value();
  EXPECT_EQ("mcp2221 SN0001 GP3", low->name());
  EXPECT_TRUE(chip_.is_output(0));
  EXPECT_FALSE(chip_.level(0));
  EXPECT_TRUE(chip_.level(3));
  ASSERT_TRUE(plain->set(true).has_value());
  ASSERT_TRUE(low->set(true).has_value());
  EXPECT_TRUE(chip_.level(0));
  EXPECT_FALSE(chip_.level(3));
  auto third = bridge_->output({.number = 1}).value();
  EXPECT_TRUE(chip_.level(0)) << "opening one pin leaves the others as they are";
  EXPECT_FALSE(chip_.level(3));
}

TEST_F(Mcp2221Test, AGroupChangesTogether) {
  const std::array<Mcp2221Pin, 2> pins{{{.number = 1}, {.number = 2, .active_low = true}}};
  auto group = bridge_->outputs(pins).value();
  EXPECT_EQ("mcp2221 SN0001 GP1+GP2", group->name());
  ASSERT_TRUE(group->set(std::array{true, true}).has_value());
  EXPECT_TRUE(chip_.level(1));
  EXPECT_FALSE(chip_.level(2));
  EXPECT_EQ(ErrorCode::invalid_argument, group->set(std::array{true}).error().code);
}

TEST_F(Mcp2221Test, OutputsEndInactiveUnlessTheyAreToStay) {
  auto ends = bridge_->output({.number = 0, .active_low = true}).value();
  auto stays = bridge_->output({.number = 1, .keep_at_end = true}).value();
  ASSERT_TRUE(ends->set(true).has_value());
  ASSERT_TRUE(stays->set(true).has_value());
  ends.reset();
  stays.reset();
  EXPECT_TRUE(chip_.level(0)) << "active low: inactive is high";
  EXPECT_TRUE(chip_.level(1));
}

TEST_F(Mcp2221Test, InputsReadWhatDrivesThem) {
  auto in = bridge_->input({.number = 2}).value();
  auto low = bridge_->input({.number = 1, .active_low = true}).value();
  for (const bool high : {true, false, true}) {
    chip_.drive(2, high);
    chip_.drive(1, high);
    EXPECT_EQ(high, in->active().value());
    EXPECT_EQ(!high, low->active().value());
  }
}

TEST_F(Mcp2221Test, APinHasOneOwner) {
  auto out = bridge_->output({.number = 0}).value();
  EXPECT_EQ(ErrorCode::busy, bridge_->input({.number = 0}).error().code);
  const std::array<Mcp2221Pin, 2> twice{{{.number = 1}, {.number = 1}}};
  EXPECT_EQ(ErrorCode::busy, bridge_->outputs(twice).error().code);
  EXPECT_EQ(ErrorCode::invalid_argument, bridge_->output({.number = 4}).error().code);
  EXPECT_EQ(ErrorCode::invalid_argument, bridge_->outputs({}).error().code);
  out.reset();
  EXPECT_TRUE(bridge_->input({.number = 0}).has_value());
}

TEST_F(Mcp2221Test, AResetOfTheChipIsNoticed) {
  auto out = bridge_->output({.number = 0}).value();
  auto in = bridge_->input({.number = 1}).value();
  chip_.power(true);
  const auto set = out->set(true);
  ASSERT_FALSE(set.has_value());
  EXPECT_EQ(ErrorCode::io, set.error().code);
  EXPECT_THAT(describe(set.error()), HasSubstr("was reset"));
  EXPECT_EQ(ErrorCode::io, in->active().error().code);
}

TEST_F(Mcp2221Test, UnpluggedAndSilentAreDifferentErrors) {
  auto out = bridge_->output({.number = 0}).value();
  chip_.hang(true);
  EXPECT_EQ(ErrorCode::timeout, out->set(true).error().code);
  EXPECT_EQ(ErrorCode::timeout, i2c().write(0x50, pattern(1)).error().code);
  chip_.hang(false);
  EXPECT_TRUE(out->set(true).has_value());
  hid_.unplug(chip_);
  EXPECT_EQ(ErrorCode::disconnected, out->set(true).error().code);
  EXPECT_EQ(ErrorCode::disconnected, i2c().write(0x50, pattern(1)).error().code);
}

TEST(Mcp2221, AnAnswerThatComesTooLateIsNotTakenForTheNext) {
  mocks::SimI2cBus wires("wires");
  mocks::SimMcp2221 chip(wires);
  mocks::FakeHid hid;
  hid.plug(chip);
  auto bridge = Mcp2221::open(hid, {}).value();
  auto in = bridge->input({.number = 0}).value();
  std::array<std::byte, 65> late{};
  late[1] = std::byte{mcp2221::kStatus};
  ASSERT_TRUE(chip.output(late));  // its answer waits, unread
  EXPECT_FALSE(in->active().value());
}

TEST(Mcp2221, HeldByTheKernelItSaysSoAndWhatToDo) {
  mocks::SimI2cBus wires("wires");
  mocks::SimMcp2221 chip(wires);
  mocks::FakeHid hid;
  EXPECT_EQ(ErrorCode::not_present, Mcp2221::open(hid, {}).error().code);
  hid.plug(chip);
  hid.hold(chip, "mcp2221");
  const auto held = Mcp2221::open(hid, {});
  ASSERT_FALSE(held.has_value());
  EXPECT_EQ(ErrorCode::busy, held.error().code);
  EXPECT_THAT(describe(held.error()), HasSubstr("driver mcp2221"));
  EXPECT_THAT(describe(held.error()), HasSubstr("blacklist"));
}

TEST(SimMcp2221, WhatIsNotDeclaredIsRefusedAndKept) {
  mocks::SimI2cBus wires("wires");
  mocks::SimMcp2221 chip(wires);
  std::array<std::byte, 65> report{};
  std::array<std::byte, 64> answer{};
  for (const int command : {0xB0, 0xB1, 0x70, 0x00, 0xFF}) {
    report[1] = static_cast<std::byte>(command);
    ASSERT_TRUE(chip.output(report));
    ASSERT_EQ(64U, chip.input(answer));
    EXPECT_EQ(std::byte{1}, answer[1]) << command;
  }
  EXPECT_EQ(5U, chip.violations().size());
  EXPECT_FALSE(chip.output(std::span(report).first(1))) << "no command";
  EXPECT_FALSE(chip.output(std::array<std::byte, 66>{})) << "a report has 64 bytes and its number";
}

// As Linux's own driver asks: short reports, addresses without the bit for reading, and no question between.
TEST(SimMcp2221, TakesWhatTheKernelsDriverSends) {
  mocks::SimI2cBus wires("wires");
  mocks::SimPca9685 servo_chip;
  wires.attach(0x41, servo_chip);
  mocks::SimMcp2221 chip(wires);
  const auto ask = [&](auto... bytes) {
    EXPECT_TRUE(chip.output(std::array{std::byte{0}, static_cast<std::byte>(bytes)...}));
    std::array<std::byte, 64> answer{};
    EXPECT_EQ(answer.size(), chip.input(answer));
    return answer;
  };
  EXPECT_EQ(std::byte{0}, ask(mcp2221::kWriteNoStop, 1, 0, 0x41 << 1, 0x00)[1]);
  EXPECT_EQ(std::byte{0}, ask(mcp2221::kReadRepeatedStart, 1, 0, 0x41 << 1)[1]);
  const auto mode = ask(mcp2221::kReadData);
  EXPECT_EQ(std::byte{1}, mode[3]) << "bytes";
  EXPECT_EQ(static_cast<std::byte>(servo_chip.reg(0)), mode[4]);
  EXPECT_TRUE(chip.violations().empty());
}

}  // namespace
}  // namespace forager::hal
