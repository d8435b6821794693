#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "hal/digital_out.hpp"
#include "hal/i2c.hpp"
#include "hal/journal.hpp"
#include "hal/pwm.hpp"
#include "servo/pca9685_wire.hpp"

namespace forager::servo {

struct Pca9685Config {
  std::uint8_t address = 0x40;
  hal::Duration period = std::chrono::milliseconds(20);
  double oscillator_hz = 25e6;  // +-3 % from chip to chip: measure it once and write it down
  bool inverted = false;        // MODE2 INVRT: pulses are low
  // A chip that lost its supply wakes up asleep, with all outputs off: it is asked so often whether it still
  // is what it was made, and is made that again if not. Zero: never.
  hal::Duration check_interval = std::chrono::milliseconds(200);
};

class Pca9685;

// One of the chip's 16 outputs. The timer, and so the period, is the chip's.
class Pca9685Channel final : public hal::PwmChannel {
 public:
  Pca9685Channel() = default;

 private:
  friend class Pca9685;
  hal::Result<> do_set_pulse(hal::Duration length) override;
  hal::Result<> do_release() override;
  [[nodiscard]] std::optional<hal::Duration> do_pulse() const override;
  [[nodiscard]] std::string_view do_name() const override { return name_; }

  Pca9685* chip_ = nullptr;
  std::uint8_t index_ = 0;
  std::string name_;
  bool pending_ = false;                 // to be sent once the chip takes it
  std::optional<hal::Duration> wanted_;  // as asked for; what the chip makes of it follows from its period
};

// PCA9685, 16 channels of 12 bits on I2C.
//
//   closed --open()--> waking --update(), 500 us--> running --set_period()--> waking
//   waking, running --found reset or unreachable--> closed; open() again, or by itself at the next check
//
// open() puts all outputs off before the oscillator runs, so nothing moves at power-up, and sets the
// auto-increment bit before the first burst: without it a burst of four bytes lands in one register. While
// waking (the data sheet guarantees no timing for 500 us) new pulses are kept and sent by the update() that
// ends it.
//
// A pulse that could not be told is an error, and still the newest wish: the chip gets it at the next check,
// or when it is back, unless it is told another one before. pulse() says what is wished for.
//
// A new period is written asleep, with the ticks that go with it: no pulse is made with old ticks at the new
// rate.
//
// Period: the prescaler is a whole number, so the true period differs by up to 2.4 % at 300 Hz and 3.8 % at
// 490 Hz. Ticks are computed from the true one: pulses are exact to half a tick (2.4 us at 50 Hz). period()
// and pulse() report what the chip really makes.
//
// Output enable: with a line, outputs are off (as MODE2 says) until running. The chip has no safe state of
// its own: what its servos need is known to their drivers, which send it in their halt(). disable() is for
// the end of all, when limp servos are safe. After a crash the chip goes on with its last pulses for as long
// as it has power.
class Pca9685 final : public hal::PwmGroup {
 public:
  enum class State : std::uint8_t { closed, waking, running };

  // Borrows all; `enable` may be null: OE is wired to ground. Sends nothing.
  Pca9685(hal::I2c& bus, hal::DigitalOut* enable, hal::Journal& journal, const Pca9685Config& config);

  // Makes the chip what the configuration says, all outputs off, and wakes it. Errors: invalid_argument
  // (oscillator or period impossible), unsupported (period outside what the prescaler can divide: 3 to 255,
  // that is 0.655 to 41.9 ms at 25 MHz), protocol (something else answers at this address), and those of
  // hal::I2c.
  [[nodiscard]] hal::Result<> open(hal::Instant now);
  // Takes a chip over that runs already as the configuration says, without touching its outputs: for whoever
  // must change some of them while others go on, when the program that made it run is gone. One that does not
  // run so is opened. Errors as open().
  [[nodiscard]] hal::Result<> adopt(hal::Instant now);
  // Ends the waking, checks the chip. Errors as open(); the next update() tries again after check_interval.
  [[nodiscard]] hal::Result<> update(hal::Instant now);

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] Pca9685Channel& channel(std::size_t index) { return channels_.at(index); }
  // Times the chip was found reset and was made anew.
  [[nodiscard]] std::uint32_t recoveries() const { return recoveries_; }
  [[nodiscard]] std::uint8_t prescale() const { return prescale_; }

  // All outputs off: by the enable line, or without one by releasing all channels. open() makes them anew.
  void disable() noexcept;

 private:
  friend class Pca9685Channel;
  hal::Result<> do_set_period(hal::Duration period) override;
  [[nodiscard]] hal::Duration do_period() const override;
  [[nodiscard]] std::string_view do_name() const override { return name_; }

  [[nodiscard]] hal::Failure refuse(hal::ErrorCode code, std::string_view operation, std::string why) const;
  [[nodiscard]] hal::Result<std::uint8_t> prescale_for(hal::Duration period) const;
  [[nodiscard]] hal::Result<> write(std::uint8_t reg, std::uint8_t value);
  [[nodiscard]] hal::Result<std::uint8_t> read(std::uint8_t reg);
  [[nodiscard]] hal::Result<> become(Pca9685Channel& channel, std::optional<hal::Duration> pulse);
  [[nodiscard]] hal::Result<> send(const Pca9685Channel& channel);
  [[nodiscard]] hal::Result<> send_pending();
  [[nodiscard]] hal::Result<> wake();
  [[nodiscard]] hal::Result<> finish_waking();
  [[nodiscard]] hal::Result<> check(hal::Instant now);
  [[nodiscard]] static bool runs(std::uint8_t mode1);
  [[nodiscard]] std::uint8_t mode2_wanted() const;
  [[nodiscard]] long ticks(hal::Duration pulse) const;

  hal::I2c* bus_;
  hal::DigitalOut* enable_;
  hal::Journal* journal_;
  Pca9685Config config_;
  std::string name_;
  std::array<Pca9685Channel, pca9685::kChannels> channels_;
  State state_ = State::closed;
  std::uint8_t prescale_ = pca9685::kPreScaleReset;
  hal::Instant now_;
  std::optional<hal::Instant> woken_at_;  // the first update after it was woken: no sooner than that
  hal::Instant next_check_;
  std::uint32_t recoveries_ = 0;
  bool was_open_ = false;
};

}  // namespace forager::servo
