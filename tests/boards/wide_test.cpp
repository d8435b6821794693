// The reference arithmetic against constants of 400 bits, printed as sums of two doubles.
#include "boards/wide.hpp"

#include <gtest/gtest.h>

namespace forager::boards {
namespace {

void expect_equal(Wide value, Wide expected, double tolerance) {
  EXPECT_LE(std::abs((value - expected).rounded()), tolerance * std::abs(expected.high)) << expected.high;
}

TEST(Wide, KeepsAHundredBits) {
  expect_equal(sqrt(Wide(2.0)), {0x1.6a09e667f3bcdp+0, -0x1.bdd3413b26456p-54}, 1e-31);
  expect_equal(Wide(1.0) / Wide(3.0), {0x1.5555555555555p-2, 0x1.5555555555555p-56}, 1e-31);
  expect_equal(Wide(1.0, 0x1p-100) * Wide(3.0) - Wide(3.0), {0x1.8p-99}, 1e-30);
  expect_equal(Wide(0x1p60) + Wide(0x1p-40) - Wide(0x1p60), {0x1p-40}, 0.0);
}

TEST(Wide, DirectionsOfAngles) {
  struct Row {
    double angle;
    Wide cos, sin;
  };
  const Row rows[] = {
      {0x1.999999999999ap-4,
       {0x1.fd712f9a817c1p-1, -0x1.fb7ab33ee2672p-55},
       {0x1.98eaecb8bcb2cp-4, 0x1.c687ae84515ddp-59}},
      {0x1p+0, {0x1.14a280fb5068cp-1, -0x1.b71edcc9344bcp-55}, {0x1.aed548f090ceep-1, 0x1.06374f484e288p-59}},
      {2.5, {-0x1.9a2f7ef858b7dp-1, -0x1.587cfaa17e973p-56}, {0x1.326af0dcfcab1p-1, -0x1.fd42734161659p-55}},
      {-3.0,
       {-0x1.fae04be85e5d2p-1, -0x1.83effc17efb54p-55},
       {-0x1.210386db6d55bp-3, -0x1.3c7205d08d063p-57}},
      {0x1.12e0be826d695p-30,
       {0x1p+0, -0x1.2725dd1d243acp-61},
       {0x1.12e0be826d695p-30, -0x1.a68cd9e985016p-93}},
      {0x1.916872b020c4ap-4,
       {0x1.fd8b18885d67fp-1, 0x1.c9117f2a90cfdp-55},
       {0x1.90c40aafbbc56p-4, 0x1.c94300e5e1d93p-60}},
  };
  for (const Row& row : rows) {
    expect_equal(direction(Wide(row.angle)).cos, row.cos, 1e-29);
    expect_equal(direction(Wide(row.angle)).sin, row.sin, 1e-29);
  }
  // The sine of the double nearest to 2 pi is what that double is short of it.
  const Wide almost = direction(Wide(0x1.921fb54442d18p+2)).sin;
  EXPECT_NEAR(almost.rounded(), -0x1.1a62633145c07p-52, 1e-30);
}

TEST(Wide, AnglesOfDirections) {
  expect_equal(atan2(Wide(1.0), Wide(2.0)), {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56}, 1e-29);
  expect_equal(atan2(Wide(0x1.12e0be826d695p-30), Wide(1.0)), {0x1.12e0be826d695p-30, -0x1.a68cd9e985016p-92},
               1e-29);
  expect_equal(atan2(Wide(3.0), Wide(-4.0)), {0x1.3fc176b7a8560p+1, -0x1.441a3bd3f1083p-58}, 1e-29);
  expect_equal(atan2(Wide(-1.0), Wide(-0x1.ad7f29abcaf48p-24)),
               {-0x1.921fb6f1c1fb3p+0, -0x1.a3e3ce5b5c040p-59}, 1e-29);
}

}  // namespace
}  // namespace forager::boards
