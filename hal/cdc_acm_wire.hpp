#pragma once

#include <cstddef>
#include <cstdint>

// Constants of the abstract control model: USB CDC 1.2 (classes: section 4) and its PSTN subclass 1.2
// (requests: section 6.3). Shared by the driver and the emulator; the code on both sides is its own.
namespace forager::hal::cdc_acm {

constexpr std::uint8_t kCommunicationClass = 0x02;
constexpr std::uint8_t kAbstractControl = 0x02;  // its subclass
constexpr std::uint8_t kDataClass = 0x0A;

constexpr std::uint8_t kSetLineCoding = 0x20;
constexpr std::uint8_t kGetLineCoding = 0x21;
constexpr std::uint8_t kSetControlLineState = 0x22;

// Table 17: rate in bits a second, low byte first; stop bits; parity; data bits.
constexpr std::size_t kLineCodingBytes = 7;
constexpr std::size_t kStopAt = 4;
constexpr std::size_t kParityAt = 5;
constexpr std::size_t kDataBitsAt = 6;
constexpr std::uint8_t kOneStop = 0;
constexpr std::uint8_t kTwoStop = 2;
constexpr std::uint8_t kNoParity = 0;
constexpr std::uint8_t kOdd = 1;
constexpr std::uint8_t kEven = 2;

// Table 18.
constexpr std::uint16_t kDtr = 1;
constexpr std::uint16_t kRts = 2;

}  // namespace forager::hal::cdc_acm
