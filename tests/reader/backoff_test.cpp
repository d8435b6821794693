#include "reader/backoff.hpp"

#include <gtest/gtest.h>

namespace forager::reader {
namespace {

using namespace std::chrono_literals;

TEST(Backoff, DoublesUpToTheCapAndStartsAgainAfterASuccess) {
  Backoff backoff(1s, 60s);
  for (const hal::Duration wait : {1s, 2s, 4s, 8s, 16s, 32s, 60s, 60s}) EXPECT_EQ(backoff.next(), wait);
  backoff.reset();
  EXPECT_EQ(backoff.next(), hal::Duration(1s));
}

TEST(Backoff, NeverOverflows) {
  Backoff backoff(1s, hal::Duration::max());
  hal::Duration last{};
  for (int i = 0; i < 200; ++i) {
    const hal::Duration wait = backoff.next();
    ASSERT_GE(wait, last);
    last = wait;
  }
}

}  // namespace
}  // namespace forager::reader
