#include "mocks/text_journal.hpp"

#include <gtest/gtest.h>

#include <string>

#include "mocks/fake_digital_out.hpp"

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;

hal::Instant at(hal::Duration since_start) { return hal::Instant(since_start); }

TEST(TextJournal, WritesOneLinePerEntryWithNanoseconds) {
  TextJournal journal;
  journal.note(at(12s + 40ms + 1ns), "mission", "heading goal 1.571");
  const std::string bytes("\xfd\x1c\x00\xff", 4);
  journal.wire(at(-1ms), "autopilot", "tx", std::as_bytes(std::span(bytes)));
  EXPECT_EQ(journal.text(), "12.040000001 mission heading goal 1.571\n-0.001000000 autopilot tx fd1c00ff\n");
  EXPECT_EQ(journal.lines(), 2U);
  EXPECT_LT(journal.find("mission"), journal.find("autopilot"));
}

TEST(TextJournal, LongWiresAreHashedAndStillTellDifferencesApart) {
  const auto line_for = [](const std::string& bytes) {
    TextJournal journal({.keep = true, .max_hex_bytes = 4, .sink = {}});
    journal.wire(at(0s), "reader", "rx", std::as_bytes(std::span(bytes)));
    return journal.text();
  };
  EXPECT_EQ(line_for("abcde").substr(0, 33),
            "0.000000000 reader rx 5 bytes #" + line_for("abcde").substr(31, 2));
  EXPECT_EQ(line_for("abcde"), line_for("abcde"));
  EXPECT_NE(line_for("abcde"), line_for("abcdf"));
  EXPECT_NE(line_for("abcdefghi"), line_for("abcdefghj"));
}

TEST(TextJournal, TheHashDependsOnEveryLineAndItsOrderNotOnKeeping) {
  const auto hash_of = [](bool keep, std::initializer_list<const char*> lines) {
    TextJournal journal({.keep = keep, .max_hex_bytes = 64, .sink = {}});
    for (const char* line : lines) journal.note(at(1s), "x", line);
    return journal.hash();
  };
  EXPECT_EQ(hash_of(true, {"a", "b"}), hash_of(false, {"a", "b"}));
  EXPECT_NE(hash_of(true, {"a", "b"}), hash_of(true, {"b", "a"}));
  EXPECT_NE(hash_of(true, {"a"}), hash_of(true, {"a", ""}));
}

TEST(TextJournal, TheSinkGetsWholeLines) {
  std::string sunk;
  TextJournal journal(
      {.keep = false, .max_hex_bytes = 64, .sink = [&](std::string_view line) { sunk += line; }});
  journal.note(at(0s), "a", "b");
  EXPECT_EQ(sunk, "0.000000000 a b\n");
  EXPECT_EQ(journal.text(), "");
}

TEST(FakeDigitalOut, EdgesStandInTheJournalInOrder) {
  TextJournal journal;
  FakeDigitalOut brake("brake", &journal);
  brake.tick(at(1s));
  ASSERT_TRUE(brake.set(true).has_value());
  ASSERT_TRUE(brake.set(true).has_value());
  journal.note(at(2s), "mission", "go");
  brake.tick(at(3s));
  ASSERT_TRUE(brake.set(false).has_value());
  EXPECT_EQ(journal.text(), "1.000000000 brake active\n2.000000000 mission go\n3.000000000 brake inactive\n");
  ASSERT_EQ(brake.edges().size(), 2U);
  EXPECT_EQ(brake.sets(), 3U);

  brake.fail_next({hal::ErrorCode::timeout, "brake", "set", "injected", "", 0});
  EXPECT_EQ(brake.set(true).error().code, hal::ErrorCode::timeout);
  brake.disconnect();
  EXPECT_EQ(brake.set(true).error().code, hal::ErrorCode::disconnected);
  EXPECT_FALSE(brake.active());
}

}  // namespace
}  // namespace forager::mocks
