#include "reader/wedge_text.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "mocks/sim_wedge.hpp"

namespace forager::reader {
namespace {

const char* const kEpc = "30349bb6000000000000002a";

// What comes out of the text a keyboard types.
std::vector<std::string> typed(std::string_view text, WedgeText& wedge) {
  mocks::SimWedge keyboard;
  keyboard.type(text);
  std::vector<Epc> epcs;
  std::array<std::byte, 8> report{};
  while (keyboard.input(report) > 0) wedge.feed(report, epcs);
  std::vector<std::string> hex;
  for (const Epc& epc : epcs) hex.push_back(epc.hex());
  return hex;
}
std::vector<std::string> typed(std::string_view text) {
  WedgeText wedge;
  return typed(text, wedge);
}
using Words = std::vector<std::string>;

TEST(WedgeText, EveryEndOfAnEpcIsTaken) {
  for (const std::string end : {"\n", "\t", " ", ",", ";", "\n\n"})
    EXPECT_EQ((Words{kEpc, "beef"}), typed(kEpc + end + "beef" + end)) << end;
}

TEST(WedgeText, WaysToWriteOneEpcAreOne) {
  EXPECT_EQ(Words{kEpc}, typed("30349BB6000000000000002A\n"));
  EXPECT_EQ(Words{kEpc}, typed("0x30349bb6000000000000002a\n"));
  EXPECT_EQ(Words{kEpc}, typed("3034-9bb6-0000-0000-0000-002a\n"));
  EXPECT_EQ(Words{kEpc}, typed("30:34:9b:b6:00:00:00:00:00:00:00:2a\n"));
}

TEST(WedgeText, WhatIsNoEpcIsCountedAndTheNextOneIsKept) {
  WedgeText wedge;
  EXPECT_EQ(Words{"beef"}, typed("hello\n123\n" + std::string(130, 'a') + "\nbeef\n", wedge));
  EXPECT_EQ(3U, wedge.counters().rejected);
  EXPECT_EQ(1U, wedge.counters().epcs);
}

TEST(WedgeText, WithoutEndsTheirLengthOrAPauseTellsThemApart) {
  WedgeText fixed(4);
  EXPECT_EQ((Words{"beef", "cafe"}), typed("beefcafe", fixed));
  WedgeText paused;
  EXPECT_TRUE(typed("beef", paused).empty());
  EXPECT_TRUE(paused.in_word());
  std::vector<Epc> epcs;
  paused.pause(epcs);
  paused.pause(epcs);
  ASSERT_EQ(1U, epcs.size());
  EXPECT_EQ("beef", epcs[0].hex());
}

TEST(WedgeText, KeysHeldDownAreTypedOnceAndSeveralInOneReportInOrder) {
  WedgeText wedge;
  std::vector<Epc> epcs;
  const auto press = [&](std::initializer_list<int> keys, int modifiers = 0) {
    std::array<std::byte, 8> report{static_cast<std::byte>(modifiers)};
    std::size_t at = 2;
    for (const int key : keys) report.at(at++) = static_cast<std::byte>(key);
    wedge.feed(report, epcs);
  };
  press({0x05});        // b
  press({0x05});        // still b
  press({0x05, 0x08});  // and e
  press({0x08});        // b is up
  press({});
  press({0x08, 0x09});           // e and f at once
  press({0x01, 1, 1, 1, 1, 1});  // too many to tell
  press({});
  press({0x06}, 0x01);  // Control and c: no text
  press({});
  press({0x28});
  ASSERT_EQ(1U, epcs.size());
  EXPECT_EQ("beef", epcs[0].hex());
  EXPECT_EQ(1U, wedge.counters().rollovers);
}

TEST(WedgeText, ReportsOfOtherSizesDoNoHarm) {
  WedgeText wedge;
  std::vector<Epc> epcs;
  const std::array<std::byte, 64> bytes{};
  for (std::size_t size = 0; size < bytes.size(); ++size) wedge.feed(std::span(bytes).first(size), epcs);
  EXPECT_EQ(62U, wedge.counters().odd_reports) << "8, and 9 with a number, are reports of keyboards";
  EXPECT_EQ(Words{"beef"}, typed("beef\n", wedge));
}

RC_GTEST_PROP(WedgeText, WhateverIsTypedAsEpcsComesOutAsThem, ()) {
  const auto some_bytes =
      rc::gen::suchThat(rc::gen::arbitrary<std::vector<std::uint8_t>>(), [](const auto& bytes) {
        return bytes.size() >= 2 && bytes.size() <= Epc::kMaxBytes && bytes.size() % 2 == 0;
      });
  const auto words =
      *rc::gen::scale(0.2, rc::gen::container<std::vector<std::vector<std::uint8_t>>>(some_bytes));
  std::string text;
  Words wanted;
  for (const auto& bytes : words) {
    wanted.push_back(Epc::from_bytes(bytes).value().hex());
    text += wanted.back() + "\n";
  }
  RC_ASSERT(typed(text) == wanted);
}

}  // namespace
}  // namespace forager::reader
