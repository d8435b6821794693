#pragma once

#include <cstdint>

#include "hal/error.hpp"
#include "hal/time.hpp"

// DShot: one 16-bit word per frame, most significant bit first: 11 bits of value, one telemetry bit, 4 bits
// of checksum. A one is high for 75 % of its bit, a zero for 37.5 %. Words only: what shifts them out (a
// timer with DMA) is not part of this program, a PwmChannel cannot.
namespace forager::flight {

inline constexpr std::uint16_t kDshotStop = 0;
inline constexpr std::uint16_t kDshotLastCommand = 47;  // 1..47 are commands
inline constexpr std::uint16_t kDshotFirstThrottle = 48;
inline constexpr std::uint16_t kDshotLastThrottle = 2047;

enum class DshotRate : std::uint16_t { dshot150 = 150, dshot300 = 300, dshot600 = 600, dshot1200 = 1200 };

enum class DshotKind : std::uint8_t {
  normal,
  bidirectional,  // line levels inverted, and so is the checksum
};

struct DshotBitTimes {
  hal::Duration bit;        // one whole bit: 6667, 3333, 1667, 833 ns
  hal::Duration one_high;   // 75 % of it
  hal::Duration zero_high;  // 37.5 % of it
};
[[nodiscard]] DshotBitTimes dshot_bit_times(DshotRate rate);
// 16 bits; the frame must be followed by silence of at least two bits.
[[nodiscard]] hal::Duration dshot_frame_time(DshotRate rate);

// The 4-bit checksum of the 12 bits `value << 1 | telemetry`.
[[nodiscard]] constexpr std::uint16_t dshot_checksum(std::uint16_t twelve_bits, DshotKind kind) {
  const unsigned v = twelve_bits & 0x0FFFU;
  const unsigned sum = v ^ (v >> 4U) ^ (v >> 8U);
  return static_cast<std::uint16_t>((kind == DshotKind::bidirectional ? ~sum : sum) & 0x0FU);
}

// The word of any 11-bit value, checked by nobody: value 1046 without telemetry is 0x82C6. Bits above the
// eleventh are dropped.
[[nodiscard]] constexpr std::uint16_t dshot_word(std::uint16_t value, bool telemetry,
                                                 DshotKind kind = DshotKind::normal) {
  const auto twelve = static_cast<std::uint16_t>(((value & 0x07FFU) << 1U) | (telemetry ? 1U : 0U));
  return static_cast<std::uint16_t>((twelve << 4U) | dshot_checksum(twelve, kind));
}

// What makes the ESC do something else than turn. Values of the DShot command list; each must be repeated.
enum class DshotCommand : std::uint16_t {
  beep1 = 1,
  beep2 = 2,
  beep3 = 3,
  beep4 = 4,
  beep5 = 5,
  direction_one = 7,
  direction_two = 8,
  save_settings = 12,
  direction_normal = 20,
  direction_reversed = 21,
};

struct DshotBurst {
  std::uint16_t word;
  int repeats;  // times the word must be sent without another in between
};

// Words for one motor, which remembers whether it runs: a command while it runs is refused, since firmware
// reads the value as a throttle below the lowest or, worse, turns the motor round in flight.
//
// Safe state: stop, at construction and after halt.
class DshotEncoder {
 public:
  explicit DshotEncoder(DshotKind kind = DshotKind::normal) : kind_(kind) {}

  // fraction: 0 is stop (value 0), anything above is 48..2047. Errors: invalid_argument (NaN, below 0, above
  // 1); the state is then as before.
  [[nodiscard]] hal::Result<std::uint16_t> throttle(double fraction, bool telemetry);
  [[nodiscard]] std::uint16_t stop() {
    running_ = false;
    return dshot_word(kDshotStop, false, kind_);
  }
  // Errors: invalid_state (the motor runs).
  [[nodiscard]] hal::Result<DshotBurst> command(DshotCommand command) const;
  [[nodiscard]] bool running() const { return running_; }

 private:
  DshotKind kind_;
  bool running_ = false;
};

}  // namespace forager::flight
