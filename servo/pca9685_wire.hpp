#pragma once

#include <cstdint>

// Registers of the PCA9685 (NXP data sheet PCA9685 rev. 4): table 4 register summary, tables 5 to 9 bits,
// section 7.3.5 PRE_SCALE. Shared by the driver and the emulator.
namespace forager::servo::pca9685 {

inline constexpr std::uint8_t kMode1 = 0x00;
inline constexpr std::uint8_t kMode2 = 0x01;
inline constexpr std::uint8_t kSubAdr1 = 0x02;
inline constexpr std::uint8_t kAllCallAdr = 0x05;
inline constexpr std::uint8_t kLed0 = 0x06;  // four a channel: ON_L, ON_H, OFF_L, OFF_H
inline constexpr std::uint8_t kLedLast = 0x45;
inline constexpr std::uint8_t kAllLed = 0xFA;
inline constexpr std::uint8_t kAllLedLast = 0xFD;
inline constexpr std::uint8_t kPreScale = 0xFE;

// MODE1
inline constexpr std::uint8_t kRestart = 0x80;
inline constexpr std::uint8_t kExtClk = 0x40;
inline constexpr std::uint8_t kAutoIncrement = 0x20;
inline constexpr std::uint8_t kSleep = 0x10;
inline constexpr std::uint8_t kAllCall = 0x01;
inline constexpr std::uint8_t kMode1Reset = 0x11;
// MODE2
inline constexpr std::uint8_t kInvert = 0x10;
inline constexpr std::uint8_t kTotemPole = 0x04;
inline constexpr std::uint8_t kMode2Reset = 0x04;
// ON_H and OFF_H
inline constexpr std::uint8_t kFull = 0x10;

inline constexpr std::uint8_t kPreScaleReset = 0x1E;
inline constexpr std::uint8_t kPreScaleMin = 3;
inline constexpr int kSteps = 4096;
inline constexpr int kChannels = 16;
inline constexpr int kOscillatorWakeUs = 500;

}  // namespace forager::servo::pca9685
