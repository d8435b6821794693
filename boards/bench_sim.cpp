#include <fmt/format.h>

#include <array>
#include <utility>

#include "boards/bench_devices.hpp"
#include "hal/linux/steady_clock.hpp"
#include "mocks/fake_digital_in.hpp"
#include "mocks/fake_digital_out.hpp"
#include "mocks/fake_pwm.hpp"
#include "mocks/sim_i2c_bus.hpp"
#include "mocks/sim_pca9685.hpp"
#include "mocks/virtual_clock.hpp"

namespace forager::boards {
namespace {

constexpr std::size_t kWires = 4;
constexpr std::uint8_t kChipAddress = 0x40;

// An output and the input it is wired to.
struct Wire {
  mocks::FakeDigitalOut out;
  mocks::FakeDigitalIn in;
  bool out_held = false;
  bool in_held = false;
};

class HeldOut final : public hal::DigitalOut {
 public:
  HeldOut(Wire& wire, hal::Clock& clock, const BenchLine& line)
      : wire_(&wire), clock_(&clock), active_low_(line.active_low), keep_(line.keep_at_end) {
    wire.out_held = true;
    static_cast<void>(drive(false));
  }
  ~HeldOut() override {
    if (!keep_) static_cast<void>(drive(false));
    wire_->out_held = false;
  }
  HeldOut(const HeldOut&) = delete;
  HeldOut& operator=(const HeldOut&) = delete;

 private:
  hal::Result<> do_set(bool active) override { return drive(active); }
  std::string_view do_name() const override { return wire_->out.name(); }
  hal::Result<> drive(bool active) {
    const bool level = active != active_low_;
    wire_->out.tick(clock_->now());
    FORAGER_TRY(wire_->out.set(level));
    wire_->in.drive(level, clock_->now());
    return {};
  }

  Wire* wire_;
  hal::Clock* clock_;
  bool active_low_;
  bool keep_;
};

class HeldIn final : public hal::EdgeIn {
 public:
  HeldIn(Wire& wire, const BenchLine& line) : wire_(&wire), active_low_(line.active_low) {
    wire.in_held = true;
    std::array<hal::Edge, 16> old;  // edges from before it was asked for are nobody's
    static_cast<void>(wire.in.edges(old));
  }
  ~HeldIn() override { wire_->in_held = false; }
  HeldIn(const HeldIn&) = delete;
  HeldIn& operator=(const HeldIn&) = delete;

 private:
  hal::Result<bool> do_active() override {
    return wire_->in.active().map([this](bool level) { return level != active_low_; });
  }
  hal::Result<std::size_t> do_edges(std::span<hal::Edge> into) override {
    auto count = wire_->in.edges(into);
    if (count)
      for (std::size_t i = 0; i < *count; ++i) into[i].active = into[i].active != active_low_;
    return count;
  }
  std::string_view do_name() const override { return wire_->in.name(); }

  Wire* wire_;
  bool active_low_;
};

class SimOutput final : public BenchPwm {
 public:
  SimOutput(mocks::FakePwmGroup& group, std::uint32_t channel) : group_(&group), channel_(channel) {}
  hal::PwmChannel& channel() override { return group_->channel(channel_); }
  hal::PwmGroup& group() override { return *group_; }
  hal::Result<> update(hal::Instant now) override {
    group_->tick(now);
    return {};
  }

 private:
  mocks::FakePwmGroup* group_;
  std::uint32_t channel_;
};

class SimMachine final : public BenchMachine {
 public:
  SimMachine(hal::Journal& journal, bool real_time)
      : clock_(real_time ? hal::make_steady_clock() : std::make_unique<mocks::VirtualClock>()),
        pwm_("sim", 2, std::chrono::milliseconds(20), &journal),
        bus_("i2c sim") {
    for (std::size_t i = 0; i < kWires; ++i)
      wires_[i] =
          std::make_unique<Wire>(Wire{mocks::FakeDigitalOut(fmt::format("gpio sim/OUT{}", i), &journal),
                                      mocks::FakeDigitalIn(fmt::format("gpio sim/IN{}", i))});
    bus_.attach(kChipAddress, pca9685_);
  }

  hal::Clock& clock() override { return *clock_; }
  bool emulated() const override { return true; }
  hal::Result<std::vector<LineFacts>> lines() override;
  hal::Result<std::unique_ptr<hal::DigitalOut>> open_out(const BenchLine& line) override;
  hal::Result<std::unique_ptr<hal::DigitalIn>> open_in(const BenchLine& line) override {
    return open_edges(line).map([](auto in) -> std::unique_ptr<hal::DigitalIn> { return in; });
  }
  hal::Result<std::unique_ptr<hal::EdgeIn>> open_edges(const BenchLine& line) override;
  hal::Result<std::vector<PwmFacts>> pwm_chips() override;
  hal::Result<std::unique_ptr<BenchPwm>> open_pwm(const PwmPlace& place, PwmStart start) override;
  std::vector<std::string> i2c_buses() override { return {"sim"}; }
  hal::Result<std::unique_ptr<hal::I2c>> open_i2c(const std::string& bus, hal::Duration timeout) override;

 private:
  hal::Result<std::size_t> number_of(const BenchLine& line) const;

  std::unique_ptr<hal::Clock> clock_;
  std::array<std::unique_ptr<Wire>, kWires> wires_;
  mocks::FakePwmGroup pwm_;
  mocks::SimPca9685 pca9685_;
  mocks::SimI2cBus bus_;
};

hal::Failure not_here(const std::string& device, std::string_view what) {
  return hal::fail(hal::ErrorCode::not_present, device, "open",
                   fmt::format("the emulated machine has {}", what),
                   "Leave --board sim out for this machine's own");
}

// 0 to 3: OUT0 to OUT3; 4 to 7: IN0 to IN3.
hal::Result<std::size_t> SimMachine::number_of(const BenchLine& line) const {
  const std::string device = fmt::format("gpio {}/{}", line.chip, line.line);
  if (line.chip != "sim") return not_here(device, "one GPIO chip, sim");
  if (const auto number = parse_number(line.line, 2 * kWires - 1)) return *number;
  for (std::size_t i = 0; i < kWires; ++i) {
    if (line.line == fmt::format("OUT{}", i)) return i;
    if (line.line == fmt::format("IN{}", i)) return kWires + i;
  }
  return not_here(device, "the lines OUT0 to OUT3 and IN0 to IN3");
}

hal::Result<std::vector<LineFacts>> SimMachine::lines() {
  std::vector<LineFacts> facts;
  for (std::uint32_t i = 0; i < 2 * kWires; ++i) {
    const bool output = i < kWires;
    const Wire& wire = *wires_[i % kWires];
    facts.push_back({.chip = "sim",
                     .label = "emulated",
                     .number = i,
                     .name = fmt::format("{}{}", output ? "OUT" : "IN", i % kWires),
                     .held_by = (output ? wire.out_held : wire.in_held) ? "forager" : "",
                     .output = output});
  }
  return facts;
}

hal::Result<std::unique_ptr<hal::DigitalOut>> SimMachine::open_out(const BenchLine& line) {
  const auto number = number_of(line);
  if (!number) return hal::fail(number.error());
  Wire& wire = *wires_[*number % kWires];
  if (*number >= kWires)
    return hal::fail(hal::ErrorCode::invalid_argument, std::string(wire.in.name()), "open",
                     "this line is an input that is wired to an output", "Drive OUT0 to OUT3");
  if (wire.out_held)
    return hal::fail(hal::ErrorCode::busy, std::string(wire.out.name()), "open",
                     "\"forager\" holds the line");
  return std::make_unique<HeldOut>(wire, *clock_, line);
}

hal::Result<std::unique_ptr<hal::EdgeIn>> SimMachine::open_edges(const BenchLine& line) {
  const auto number = number_of(line);
  if (!number) return hal::fail(number.error());
  Wire& wire = *wires_[*number % kWires];
  if (wire.in_held)
    return hal::fail(hal::ErrorCode::busy, std::string(wire.in.name()), "open", "\"forager\" holds the line");
  return std::make_unique<HeldIn>(wire, line);  // a line of OUT is read where its wire ends
}

hal::Result<std::vector<PwmFacts>> SimMachine::pwm_chips() {
  PwmFacts chip{.chip = "sim", .device = "emulated", .channels = 2, .exported = {}};
  for (std::uint32_t i = 0; i < chip.channels; ++i)
    if (const auto pulse = pwm_.channel(i).pulse()) chip.exported.push_back({i, true, *pulse, pwm_.period()});
  return std::vector{std::move(chip)};
}

hal::Result<std::unique_ptr<BenchPwm>> SimMachine::open_pwm(const PwmPlace& place, PwmStart) {
  if (place.backend != PwmBackend::sim || place.channel > 1)
    return not_here("pwm " + to_string(place), "the outputs sim/0 and sim/1");
  FORAGER_TRY(pwm_.set_period(place.period));
  return std::make_unique<SimOutput>(pwm_, place.channel);
}

// The bus outlives the command; what is handed out only leads to it.
class BorrowedBus final : public hal::I2c {
 public:
  explicit BorrowedBus(hal::I2c& bus) : bus_(&bus) {}

 private:
  hal::Result<> do_transfer(std::uint8_t address, std::span<const std::byte> bytes,
                            std::span<std::byte> into) override {
    return into.empty()    ? bus_->write(address, bytes)
           : bytes.empty() ? bus_->read(address, into)
                           : bus_->write_read(address, bytes, into);
  }
  std::string_view do_name() const override { return bus_->name(); }
  hal::I2c* bus_;
};

hal::Result<std::unique_ptr<hal::I2c>> SimMachine::open_i2c(const std::string& bus, hal::Duration) {
  if (bus != "sim") return not_here("i2c " + bus, "the I2C bus sim");
  pca9685_.advance(clock_->now());
  return std::make_unique<BorrowedBus>(bus_);
}

}  // namespace

std::unique_ptr<BenchMachine> make_sim_machine(hal::Journal& journal, bool real_time) {
  return std::make_unique<SimMachine>(journal, real_time);
}

}  // namespace forager::boards
