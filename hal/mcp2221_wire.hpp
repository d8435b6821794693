#pragma once

#include <cstddef>
#include <cstdint>

// Commands and answers of the MCP2221A (Microchip DS20005565, section 3.1), each a report of 64 bytes; codes
// of its I2C engine as the hid-mcp2221 driver of Linux knows them. Shared by the driver and the emulator; the
// code on both sides is its own.
namespace forager::hal::mcp2221 {

inline constexpr std::uint16_t kVendor = 0x04D8;
inline constexpr std::uint16_t kProduct = 0x00DD;
inline constexpr std::size_t kReportBytes = 64;
inline constexpr std::size_t kPins = 4;

// Commands: byte 0 of the report, and of its answer.
inline constexpr std::uint8_t kStatus = 0x10;
inline constexpr std::uint8_t kReadData = 0x40;
inline constexpr std::uint8_t kSetGpio = 0x50;
inline constexpr std::uint8_t kGetGpio = 0x51;
inline constexpr std::uint8_t kSetSram = 0x60;
inline constexpr std::uint8_t kGetSram = 0x61;
inline constexpr std::uint8_t kWrite = 0x90;
inline constexpr std::uint8_t kRead = 0x91;
inline constexpr std::uint8_t kReadRepeatedStart = 0x93;
inline constexpr std::uint8_t kWriteNoStop = 0x94;

// Byte 1 of an answer.
inline constexpr std::uint8_t kDone = 0x00;
inline constexpr std::uint8_t kBusyOrUnknown = 0x01;  // I2C: the engine is busy; else: no such command
inline constexpr std::uint8_t kNotYet = 0x41;         // kReadData: nothing to hand out

// kStatus. Request: byte 2 cancels, byte 3 sets the speed in byte 4. Answer: what became of it in 2 and 3.
inline constexpr std::size_t kCancelAt = 2;
inline constexpr std::uint8_t kCancel = 0x10;
inline constexpr std::uint8_t kCancelIdle = 0x11;  // there was nothing to cancel
inline constexpr std::size_t kSetSpeedAt = 3;
inline constexpr std::uint8_t kSetSpeed = 0x20;
inline constexpr std::uint8_t kSpeedRefused = 0x21;  // a transfer is under way
inline constexpr std::size_t kDividerAt = 4;
inline constexpr std::size_t kEngineAt = 8;
inline constexpr std::size_t kAcknowledgeAt = 20;
inline constexpr std::uint8_t kNotAcknowledged = 0x40;
inline constexpr std::size_t kSclAt = 22;
inline constexpr std::size_t kSdaAt = 23;
inline constexpr std::size_t kHardwareAt = 46;  // two letters of hardware, two of firmware
inline constexpr std::uint32_t kClockHz = 12'000'000;
inline constexpr std::uint32_t kDividerOffset = 3;  // speed = clock / (divider + 3)

// States of the engine, in byte 8 of kStatus and byte 2 of others.
inline constexpr std::uint8_t kIdle = 0x00;
inline constexpr std::uint8_t kStartTimeout = 0x12;
inline constexpr std::uint8_t kRepeatedStartTimeout = 0x17;
inline constexpr std::uint8_t kAddressSent = 0x21;
inline constexpr std::uint8_t kAddressTimeout = 0x23;
inline constexpr std::uint8_t kAddressRefused = 0x25;
inline constexpr std::uint8_t kPartialData = 0x41;
inline constexpr std::uint8_t kDataTimeout = 0x44;
inline constexpr std::uint8_t kNoStopDone = 0x45;  // written, the bus still held
inline constexpr std::uint8_t kReadPartial = 0x54;
inline constexpr std::uint8_t kReadComplete = 0x55;
inline constexpr std::uint8_t kStopTimeout = 0x62;

// Transfers: bytes 1 and 2 the whole length, low byte first; 3 the address with the R/W bit; then data.
// Answer of kReadData: byte 2 the state, byte 3 how many, then data.
inline constexpr std::size_t kDataAt = 4;
inline constexpr std::size_t kDataBytes = 60;
inline constexpr std::uint8_t kReadFailed = 127;  // instead of how many

// kSetGpio: four bytes a pin from 2 on: alter output, level, alter direction, direction. Answer of kGetGpio:
// two a pin from 2 on, level and direction.
inline constexpr std::size_t kPinAt = 2;
inline constexpr std::uint8_t kInput = 1;
inline constexpr std::uint8_t kNotGpioLevel = 0xEE;
inline constexpr std::uint8_t kNotGpioDirection = 0xEF;

// kSetSram: byte 7 alters the pins, 8 to 11 are they. Answer of kGetSram: pins at 22 to 25.
inline constexpr std::size_t kAlterPinsAt = 7;
inline constexpr std::uint8_t kAlterPins = 0x80;
inline constexpr std::size_t kSetPinsAt = 8;
inline constexpr std::size_t kGetPinsAt = 22;
inline constexpr std::uint8_t kPinHigh = 0x10;
inline constexpr std::uint8_t kPinInput = 0x08;
inline constexpr std::uint8_t kPinUse = 0x07;  // 0: GPIO

}  // namespace forager::hal::mcp2221
