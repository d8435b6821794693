#include "hal/ftdi_rate.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace forager::hal {
namespace {

struct Published {
  std::uint32_t baud;
  std::uint32_t divisor;
};

// FTDI's application note AN232B-05, the table of divisors for the FT232BM and later.
constexpr Published kTable[] = {
    {300, 0x2710},    {600, 0x1388},       {1200, 0x09C4},      {2400, 0x04E2},
    {4800, 0x0271},   {9600, 0x4138},      {19200, 0x809C},     {38400, 0xC04E},
    {57600, 0xC034},  {115200, 0x001A},    {230400, 0x000D},    {460800, 0x4006},
    {921600, 0x8003}, {1'000'000, 0x0003}, {2'000'000, 0x0001}, {3'000'000, 0x0000}};

TEST(FtdiRate, DivisorsAreThoseOfTheApplicationNote) {
  for (const Published& row : kTable) {
    const FtdiRate rate = ftdi_rate(row.baud, false);
    EXPECT_EQ(row.divisor, rate.divisor) << row.baud;
    EXPECT_LT(std::abs(rate.error), 0.0017) << row.baud;
  }
}

TEST(FtdiRate, WhatTheDividerCannotDoItSays) {
  EXPECT_NEAR(2'000'000.0, ftdi_rate(2'300'000, false).baud, 1e-6);
  EXPECT_NEAR(-1.0 / 6.0, ftdi_rate(2'400'000, false).error, 1e-9);
  EXPECT_GT(ftdi_rate(100, false).error, 0.5);
  EXPECT_NEAR(12e6, ftdi_rate(12'000'000, true).baud, 1e-6);
}

RC_GTEST_PROP(FtdiRate, NoOtherDivisorComesNearer, ()) {
  const auto asked = *rc::gen::inRange<std::uint32_t>(200, 3'000'000);
  const FtdiRate rate = ftdi_rate(asked, false);
  const double eighths = 24e6 / rate.baud;
  for (const double other : {std::floor(eighths + 0.5) - 1.0, std::floor(eighths + 0.5) + 1.0}) {
    const bool possible = other == 8.0 || other == 12.0 || other >= 16.0;
    if (possible) RC_ASSERT(std::abs(24e6 / other - asked) >= std::abs(rate.baud - asked));
  }
}

}  // namespace
}  // namespace forager::hal
