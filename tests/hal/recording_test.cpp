#include "hal/recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "mocks/virtual_clock.hpp"

namespace forager::hal {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

bool same(const Record& a, const Record& b) {
  if (a.at != b.at || a.device != b.device || a.operation != b.operation || a.asked != b.asked ||
      a.answer.has_value() != b.answer.has_value())
    return false;
  if (a.answer) return *a.answer == *b.answer;
  const Error& x = a.answer.error();
  const Error& y = b.answer.error();
  return x.code == y.code && x.device == y.device && x.operation == y.operation && x.detail == y.detail &&
         x.mend == y.mend && x.sys_errno == y.sys_errno;
}

TEST(Recording, IsStableTextThatAPersonCanRead) {
  mocks::VirtualClock clock(Instant(12'040ms));
  std::string text;
  Recorder recorder(clock, [&](std::string_view line) { text += line; });
  recorder.take("i2c /dev/i2c-1", "transfer", {field(0x40), "06", field(2)}, Fields{"1e00"});
  clock.advance(20ms);
  recorder.take("-", "<bytes", {""}, fail(ErrorCode::no_ack, "a=b", "100 %", "", "", 6));
  EXPECT_EQ(text,
            "forager recording 1\n"
            "12.040000000 recorder start = ok\n"
            "12.040000000 i2c%20/dev/i2c-1 transfer 64 06 2 = ok 1e00\n"
            "12.060000000 %2d <bytes - = error no_ack a%3db 100%20%25 - - 6\n");
  EXPECT_EQ(3U, recorder.records());
  const auto records = parse_recording(text);
  ASSERT_TRUE(records) << describe(records.error());
  ASSERT_EQ(3U, records->size());
  EXPECT_EQ("100 %", (*records)[2].answer.error().operation);
}

RC_GTEST_PROP(Recording, WhatIsWrittenIsReadBack, ()) {
  const auto text = rc::gen::string<std::string>();
  Record record;
  record.at = Instant(Duration(*rc::gen::inRange<std::int64_t>(-1'000'000'000'000, 1'000'000'000'000)));
  record.device = *text;
  record.operation = *text;
  record.asked = *rc::gen::container<Fields>(text);
  if (*rc::gen::arbitrary<bool>())
    record.answer = *rc::gen::container<Fields>(text);
  else
    record.answer = fail(static_cast<ErrorCode>(*rc::gen::inRange(0, 13)), *text, *text, *text, *text,
                         *rc::gen::inRange(0, 4096));
  const auto read = parse_record(to_line(record));
  RC_ASSERT(read.has_value());
  RC_ASSERT(same(record, *read));
}

RC_GTEST_PROP(Recording, FieldsGiveTheSameValueBack, (double number, std::int64_t integer)) {
  RC_ASSERT(number_in(field(number)) == number);
  RC_ASSERT(integer_in(field(integer)) == integer);
}

TEST(Recording, SaysWhichLineIsBroken) {
  const auto why = [](const std::string& lines) {
    const auto read = parse_recording("forager recording 1\n" + lines);
    return read ? "accepted" : read.error().detail;
  };
  EXPECT_THAT(why("1.000000000 a b = ok\nnonsense\n"), HasSubstr("line 3: a record is"));
  EXPECT_THAT(why("1.0 a b = ok\n"), HasSubstr("\"1.0\" is no time"));
  EXPECT_THAT(why("1.000000000 a b = maybe\n"), HasSubstr("ok or error"));
  EXPECT_THAT(why("1.000000000 a b = error gone a b c d 0\n"), HasSubstr("another code"));
  EXPECT_THAT(why("1.000000000 a  b = ok\n"), HasSubstr("two spaces"));
  EXPECT_THAT(why("1.000000000 a b %2 = ok\n"), HasSubstr("\"%2\" is no field"));
  EXPECT_THAT(parse_recording("hello\n").error().detail, HasSubstr("this is no recording"));
  EXPECT_FALSE(parse_recording(""));
}

TEST(Recording, ALineThatWasCutOffAtTheEndIsLeftOut) {
  const auto read = parse_recording("forager recording 1\n# a note\n1.000000000 a b = ok\n2.0000");
  ASSERT_TRUE(read) << describe(read.error());
  EXPECT_EQ(1U, read->size());
}

TEST(Recording, BytesAreDigitsAndNothingElse) {
  EXPECT_EQ(2U, bytes_in("0aff")->size());
  EXPECT_FALSE(bytes_in("0af"));
  EXPECT_FALSE(bytes_in("0g"));
  EXPECT_FALSE(integer_in("12 "));
  EXPECT_FALSE(number_in(""));
}

}  // namespace
}  // namespace forager::hal
