#include "mocks/faulty_stream.hpp"

#include <gtest/gtest.h>

#include <string>

#include "mocks/memory_stream.hpp"

namespace forager::mocks {
namespace {

struct Outcome {
  std::string heard;     // by the device, of what the driver wrote
  std::string answered;  // by the driver, of what the device wrote
  int reads_with_bytes = 0;
  std::uint64_t faults = 0;
  bool disconnected = false;
};

// 50 messages each way over a line with these faults.
Outcome talk(const StreamFaults& read, const StreamFaults& write, std::uint64_t seed = 1) {
  MemoryStreamPair line("line", MemoryStreamKind::bytes, 4096);
  FaultyStream faulty(line.near(), read, write, seed);
  Outcome outcome;
  EXPECT_TRUE(faulty.open().has_value() && faulty.poll().has_value());
  std::string buffer(256, '\0');
  const auto drain = [&] {
    const auto count = faulty.read(std::as_writable_bytes(std::span(buffer)));
    outcome.disconnected = outcome.disconnected || !count;
    if (count.value_or(0) > 0) ++outcome.reads_with_bytes;
    outcome.answered += buffer.substr(0, count.value_or(0));
  };
  for (int k = 0; k < 50 && !outcome.disconnected; ++k) {
    const std::string message = "message " + std::to_string(100 + k) + ";";
    for (std::string_view rest = message; !rest.empty() && !outcome.disconnected;) {
      const auto taken = faulty.write(std::as_bytes(std::span(rest)));
      outcome.disconnected = !taken;
      rest.remove_prefix(taken.value_or(0));
    }
    if (outcome.disconnected) break;
    EXPECT_TRUE(line.far().write(std::as_bytes(std::span(message))).has_value());
    drain();
    const auto count = line.far().read(std::as_writable_bytes(std::span(buffer)));
    outcome.heard += buffer.substr(0, count.value_or(0));
  }
  for (int k = 0; k < 1000 && !outcome.disconnected; ++k) drain();
  const auto count = outcome.disconnected ? hal::Result<std::size_t>(std::size_t{0})
                                          : line.far().read(std::as_writable_bytes(std::span(buffer)));
  outcome.heard += buffer.substr(0, count.value_or(0));
  outcome.faults = faulty.faults();
  return outcome;
}

std::string all_messages() {
  std::string text;
  for (int k = 0; k < 50; ++k) text += "message " + std::to_string(100 + k) + ";";
  return text;
}

TEST(FaultyStream, WithoutFaultsItIsTheLine) {
  const Outcome outcome = talk({}, {});
  EXPECT_EQ(outcome.heard, all_messages());
  EXPECT_EQ(outcome.answered, all_messages());
  EXPECT_EQ(outcome.faults, 0U);
}

TEST(FaultyStream, SplittingAndJoiningLoseNothing) {
  StreamFaults split;
  split.split = 0.5;
  StreamFaults join;
  join.join = 0.5;
  const Outcome in_pieces = talk(split, split);
  const Outcome in_lumps = talk(join, join);
  for (const Outcome& outcome : {in_pieces, in_lumps}) {
    EXPECT_EQ(outcome.heard, all_messages());
    EXPECT_EQ(outcome.answered, all_messages());
  }
  EXPECT_GT(in_pieces.reads_with_bytes, 50);
  EXPECT_LT(in_lumps.reads_with_bytes, 50);
}

TEST(FaultyStream, DroppingFlippingAndGarbageShow) {
  StreamFaults drop;
  drop.drop = 0.05;
  const Outcome dropped = talk(drop, drop);
  EXPECT_LT(dropped.answered.size(), all_messages().size());
  EXPECT_LT(dropped.heard.size(), all_messages().size());
  EXPECT_GT(dropped.heard.size(), all_messages().size() / 2);

  StreamFaults flip;
  flip.flip = 0.05;
  const Outcome flipped = talk(flip, {});
  EXPECT_EQ(flipped.answered.size(), all_messages().size());
  EXPECT_NE(flipped.answered, all_messages());

  StreamFaults garbage;
  garbage.garbage = 1.0;
  EXPECT_GT(talk(garbage, {}).answered.size(), all_messages().size() + 50);
}

TEST(FaultyStream, DisconnectsSoonerOrLater) {
  StreamFaults faults;
  faults.disconnect = 0.05;
  EXPECT_TRUE(talk(faults, {}).disconnected);
  EXPECT_TRUE(talk({}, faults).disconnected);
}

TEST(FaultyStream, EqualSeedsBreakEqually) {
  StreamFaults faults;
  faults.drop = faults.flip = faults.garbage = faults.split = 0.1;
  EXPECT_EQ(talk(faults, faults, 3).answered, talk(faults, faults, 3).answered);
  EXPECT_NE(talk(faults, faults, 3).answered, talk(faults, faults, 4).answered);
}

}  // namespace
}  // namespace forager::mocks
