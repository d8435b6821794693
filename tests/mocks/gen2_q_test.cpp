#include "mocks/gen2_q.hpp"

#include <gtest/gtest.h>

namespace forager::mocks {
namespace {

TEST(QAlgorithm, FollowsWhatTheReaderSees) {
  QAlgorithm q(4.0, 0.3);
  EXPECT_EQ(q.q(), 4);
  q.empty();
  EXPECT_EQ(q.q(), 4);
  q.empty();
  EXPECT_EQ(q.q(), 3) << "3.4";
  q.collided();
  q.collided();
  q.collided();
  EXPECT_NEAR(q.floating(), 4.3, 1e-12);
}

TEST(QAlgorithm, StaysBetween0And15) {
  QAlgorithm q(0.2, 0.5);
  for (int i = 0; i < 3; ++i) q.empty();
  EXPECT_EQ(q.floating(), 0.0);
  for (int i = 0; i < 60; ++i) q.collided();
  EXPECT_EQ(q.floating(), 15.0);
}

TEST(QAlgorithm, WithoutAStepItIsFixed) {
  QAlgorithm q(6.0, 0.0);
  EXPECT_TRUE(q.fixed());
  for (int i = 0; i < 60; ++i) q.collided();
  EXPECT_EQ(q.q(), 6);
}

}  // namespace
}  // namespace forager::mocks
