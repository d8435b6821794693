#pragma once

#include <cstddef>
#include <cstdint>

// Constants of FTDI's serial chips: vendor requests to the device, as in FTDI's application notes AN232B-05
// (rates) and AN232B-04 (latency timer and packets), and in the ftdi_sio driver of Linux. Shared by the
// driver and the emulator; the code on both sides is its own.
namespace forager::hal::ftdi {

constexpr std::uint16_t kVendor = 0x0403;

constexpr std::uint8_t kReset = 0;
constexpr std::uint8_t kSetModemControl = 1;
constexpr std::uint8_t kSetFlowControl = 2;
constexpr std::uint8_t kSetBaudRate = 3;
constexpr std::uint8_t kSetData = 4;
constexpr std::uint8_t kGetModemStatus = 5;
constexpr std::uint8_t kSetLatencyTimer = 9;
constexpr std::uint8_t kGetLatencyTimer = 10;

constexpr std::uint16_t kResetAll = 0;  // values of kReset
constexpr std::uint16_t kPurgeReceived = 1;
constexpr std::uint16_t kPurgeSending = 2;

constexpr std::uint16_t kDtrHigh = 0x0101;  // values of kSetModemControl: high byte says which
constexpr std::uint16_t kDtrLow = 0x0100;
constexpr std::uint16_t kRtsHigh = 0x0202;
constexpr std::uint16_t kRtsLow = 0x0200;

constexpr std::uint16_t kRtsCts = 0x0100;  // index of kSetFlowControl

constexpr unsigned kParityShift = 8;  // value of kSetData: data bits, parity, stop bits
constexpr std::uint16_t kNoParity = 0;
constexpr std::uint16_t kOdd = 1;
constexpr std::uint16_t kEven = 2;
constexpr unsigned kStopShift = 11;
constexpr std::uint16_t kOneStop = 0;
constexpr std::uint16_t kTwoStop = 2;

// Every packet to the host begins with modem and line status.
constexpr std::size_t kStatusBytes = 2;
constexpr std::uint8_t kModemReserved = 0x01;
constexpr std::uint8_t kClearToSend = 0x10;
constexpr std::uint8_t kDataSetReady = 0x20;
constexpr std::uint8_t kOverrun = 0x02;
constexpr std::uint8_t kParityError = 0x04;
constexpr std::uint8_t kFramingError = 0x08;
constexpr std::uint8_t kBreak = 0x10;
constexpr std::uint8_t kTransmitterEmpty = 0x60;

// Generations, by bcdDevice.
constexpr std::uint16_t kFt232Bm = 0x0400;
constexpr std::uint16_t kFt2232C = 0x0500;
constexpr std::uint16_t kFt232R = 0x0600;
constexpr std::uint16_t kFt2232H = 0x0700;
constexpr std::uint16_t kFt4232H = 0x0800;
constexpr std::uint16_t kFt232H = 0x0900;
constexpr std::uint16_t kFtX = 0x1000;

// AN232B-05: rate = clock / divisor, the divisor in eighths from 2 on; below there are 1 and 1.5 only, coded
// as 0 and 1. The eighths are coded in this order at bits 14 to 16 of the divisor.
constexpr std::uint32_t kClock = 3'000'000;
constexpr std::uint32_t kFastClock = 12'000'000;    // chips of the H generation
constexpr std::uint32_t kFastClockBit = 1U << 17U;  // asks for it
constexpr std::uint32_t kFastClockFrom = 1200;      // bits a second
constexpr std::uint8_t kEighths[8] = {0, 3, 2, 4, 1, 5, 6, 7};
constexpr unsigned kEighthsShift = 14;

}  // namespace forager::hal::ftdi
