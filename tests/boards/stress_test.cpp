// Every numerically hard case, as `forager stress` asks them.
#include "boards/stress_case.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace forager::boards {
namespace {

TEST(Stress, EveryCaseStaysWithinItsBound) {
  std::set<std::string> names;
  for (const StressCase& c : stress_cases()) {
    EXPECT_TRUE(c.ok()) << c.name << ": " << c.worst << " is beyond " << c.bound;
    EXPECT_TRUE(names.insert(c.name).second) << "two cases named " << c.name;
  }
  EXPECT_GE(names.size(), 25U);
}

TEST(Stress, WorstRemembersWhatIsNoNumber) {
  Worst worst;
  worst.add(1e-3);
  worst.near(2.0, 2.5);
  EXPECT_EQ(worst.against("case", 1.0).worst, 0.5);
  EXPECT_TRUE(worst.against("case", 0.5).ok());
  EXPECT_FALSE(worst.against("case", 0.49).ok());
  worst.add(std::numeric_limits<double>::quiet_NaN());
  worst.add(0.1);
  EXPECT_FALSE(worst.against("case", HUGE_VAL).ok());
  Worst broken;
  broken.must(true);
  EXPECT_TRUE(broken.against("case", 0.0).ok());
  broken.must(false);
  EXPECT_FALSE(broken.against("case", 1e300).ok());
}

}  // namespace
}  // namespace forager::boards
