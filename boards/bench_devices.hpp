#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "boards/bench_board.hpp"
#include "hal/digital_in.hpp"
#include "hal/digital_out.hpp"
#include "hal/error.hpp"
#include "hal/i2c.hpp"
#include "hal/journal.hpp"
#include "hal/pwm.hpp"
#include "hal/time.hpp"

namespace forager::hal {
class Kernel;
}

namespace forager::boards {

struct LineFacts {
  std::string chip;   // "gpiochip0"
  std::string label;  // "pinctrl-bcm2711"
  std::uint32_t number = 0;
  std::string name;     // may be empty
  std::string held_by;  // may be empty: free
  bool output = false;
  bool active_low = false;
};

struct PwmFacts {
  std::string chip;    // "pwmchip0"
  std::string device;  // "fe20c000.pwm"
  std::uint32_t channels = 0;
  struct Running {
    std::uint32_t channel = 0;
    bool enabled = false;
    hal::Duration pulse{};
    hal::Duration period{};
  };
  std::vector<Running> exported;
};

// One PWM output with its timer. Owns whatever is between it and the machine. The end of the object leaves
// the pulses as they are.
class BenchPwm {
 public:
  virtual ~BenchPwm() = default;
  [[nodiscard]] virtual hal::PwmChannel& channel() = 0;
  [[nodiscard]] virtual hal::PwmGroup& group() = 0;
  // Lets a chip on a bus live: it starts its oscillator, and is checked. Errors: those of the chip.
  [[nodiscard]] virtual hal::Result<> update(hal::Instant now) = 0;
};

enum class PwmStart : std::uint8_t {
  anew,       // a chip on a bus is set up, all its outputs off first
  take_over,  // one that runs goes on: for whoever ends what a dead program left
};

// Where a bench command finds its lines, channels and buses: this machine, or an emulation of one. What it
// opens may not outlive it.
class BenchMachine {
 public:
  virtual ~BenchMachine() = default;
  // Time on which edges are stamped; jumps where the machine is emulated and nobody asked for real time.
  [[nodiscard]] virtual hal::Clock& clock() = 0;
  [[nodiscard]] virtual bool emulated() const = 0;

  [[nodiscard]] virtual hal::Result<std::vector<LineFacts>> lines() = 0;
  [[nodiscard]] virtual hal::Result<std::unique_ptr<hal::DigitalOut>> open_out(const BenchLine& line) = 0;
  [[nodiscard]] virtual hal::Result<std::unique_ptr<hal::DigitalIn>> open_in(const BenchLine& line) = 0;
  [[nodiscard]] virtual hal::Result<std::unique_ptr<hal::EdgeIn>> open_edges(const BenchLine& line) = 0;

  [[nodiscard]] virtual hal::Result<std::vector<PwmFacts>> pwm_chips() = 0;
  [[nodiscard]] virtual hal::Result<std::unique_ptr<BenchPwm>> open_pwm(const PwmPlace& place,
                                                                        PwmStart start = PwmStart::anew) = 0;

  // Paths of the I2C buses there are.
  [[nodiscard]] virtual std::vector<std::string> i2c_buses() = 0;
  [[nodiscard]] virtual hal::Result<std::unique_ptr<hal::I2c>> open_i2c(const std::string& bus,
                                                                        hal::Duration timeout) = 0;
};

// This machine, by the backends that were built. The journal must outlive it. kernel null: Linux.
[[nodiscard]] std::unique_ptr<BenchMachine> make_real_machine(hal::Journal& journal,
                                                              hal::Kernel* kernel = nullptr);

// One that exists in this process only, chip "sim": eight GPIO lines OUT0..OUT3 and IN0..IN3, each output
// wired to the input of its number; two PWM channels; an I2C bus "sim" with a PCA9685 at 0x40. Time jumps
// unless real_time.
[[nodiscard]] std::unique_ptr<BenchMachine> make_sim_machine(hal::Journal& journal, bool real_time);

}  // namespace forager::boards
