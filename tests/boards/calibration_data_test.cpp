// The files of a recording: taken strictly, complained about with line and column.
#include "boards/calibration_data.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace forager::boards {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kReads = "time_s,epc,port,rssi\n1.5,ABCD,3,-61\n0.5,abcd,4,-70.5\n";
constexpr const char* kPoses = "time_s,x,y,z,yaw\n0,0,0,1.8,0\n1,0.25,0,1.8,0.1\n";
constexpr const char* kTags = "epc,x,y,z\nabcd,1,2,1.5\n";

std::string complaint(const std::string& reads, const std::string& poses, const std::string& tags) {
  const auto recording = parse_recording(reads, poses, tags);
  return recording ? "taken" : describe(recording.error());
}

TEST(Recording, IsReadAndSorted) {
  const auto recording = parse_recording(kReads, kPoses, kTags);
  ASSERT_TRUE(recording) << describe(recording.error());
  ASSERT_EQ(recording->reads.size(), 2U);
  EXPECT_EQ(recording->reads[0].time_s, 0.5);
  EXPECT_EQ(recording->reads[0].port, 4);
  EXPECT_EQ(recording->reads[1].rssi_dbm, -61.0);
  EXPECT_EQ(recording->poses[1].pose.position.x, 0.25);
  EXPECT_EQ(recording->poses[1].pose.yaw_rad, 0.1);
  EXPECT_EQ(recording->tags[0].position.z, 1.5);
}

TEST(Recording, ColumnsMayStandInAnyOrderAndLinesEndInCrLf) {
  const auto recording = parse_recording("epc,rssi,port,time_s\r\nabcd,-61,3,1\r\n", kPoses,
                                         "\xEF\xBB\xBFz,y,x,epc\n3,2,1,abcd\n");
  ASSERT_TRUE(recording) << describe(recording.error());
  EXPECT_EQ(recording->reads.at(0).time_s, 1.0);
  EXPECT_EQ(recording->tags[0].position, (hal::Vec3{1.0, 2.0, 3.0}));
}

TEST(Recording, TagsOfUnknownPlaceAreCountedNotGuessed) {
  const auto recording = parse_recording("time_s,epc,port,rssi\n1,beef,1,-60\n", kPoses, kTags);
  ASSERT_TRUE(recording);
  EXPECT_EQ(recording->strangers, 1U);
  EXPECT_TRUE(recording->reads.empty());
}

struct Bad {
  const char* reads;
  const char* poses;
  const char* tags;
  std::vector<const char*> said;
};

TEST(Recording, EveryMistakeIsNamedWithLineAndColumn) {
  const Bad cases[] = {
      {"", kPoses, kTags, {"reads", "line 1", "no header"}},
      {"time_s,epc,port\n", kPoses, kTags, {"reads", "line 1", "no column 'rssi'"}},
      {"time_s,epc,port,rssi,phase\n",
       kPoses,
       kTags,
       {"reads", "line 1", "column 5", "unknown name 'phase'"}},
      {"time_s,epc,port,rssi,port\n", kPoses, kTags, {"line 1", "'port' stands twice"}},
      {"time_s,epc,port,rssi\n1,abcd,3\n", kPoses, kTags, {"line 2", "has 3 fields, the header 4"}},
      {"time_s,epc,port,rssi\n1,abcd,3,-6x\n",
       kPoses,
       kTags,
       {"line 2", "column rssi", "'-6x' is not a number"}},
      {"time_s,epc,port,rssi\n1,abcd,3,\n", kPoses, kTags, {"line 2", "column rssi", "is empty"}},
      {"time_s,epc,port,rssi\nnan,abcd,3,-60\n", kPoses, kTags, {"line 2", "column time_s", "not a number"}},
      {"time_s,epc,port,rssi\n1e999,abcd,3,-60\n", kPoses, kTags, {"line 2", "column time_s"}},
      {"time_s,epc,port,rssi\n1,abcd,0,-60\n",
       kPoses,
       kTags,
       {"line 2", "column port", "0 is not within 1 to 32"}},
      {"time_s,epc,port,rssi\n1,abcd,3.0,-60\n",
       kPoses,
       kTags,
       {"line 2", "column port", "not a whole number"}},
      {"time_s,epc,port,rssi\n1,abc,3,-60\n", kPoses, kTags, {"line 2", "column epc", "hexadecimal"}},
      {"time_s,epc,port,rssi\n1,wxyz,3,-60\n", kPoses, kTags, {"line 2", "column epc", "hexadecimal"}},
      {"time_s,epc,port,rssi\n\n1,abcd,3,-60\n", kPoses, kTags, {"line 2", "is empty"}},
      {kReads,
       "time_s,x,y,z,yaw\n1,0,0,0,0\n1,0,0,0,0\n",
       kTags,
       {"poses", "line 3", "column time_s", "not after"}},
      {kReads, "time_s,x,y,z,yaw\n1,inf,0,0,0\n", kTags, {"poses", "line 2", "column x"}},
      {kReads,
       kPoses,
       "epc,x,y,z\nabcd,0,0,0\nABCD,1,1,1\n",
       {"tags", "line 3", "column epc", "stands twice"}},
  };
  for (const Bad& bad : cases)
    for (const char* part : bad.said) EXPECT_THAT(complaint(bad.reads, bad.poses, bad.tags), HasSubstr(part));
}

TEST(Recording, NoFileIsAnErrorWithItsName) {
  const auto recording = load_recording("/no/such/reads.csv", "/no/such/poses.csv", "/no/such/tags.csv");
  ASSERT_FALSE(recording);
  EXPECT_EQ(recording.error().code, hal::ErrorCode::not_present);
  EXPECT_THAT(describe(recording.error()), HasSubstr("/no/such/reads.csv"));
}

RC_GTEST_PROP(RecordingFiles, WhatIsWrittenIsReadBack, ()) {
  Recording recording;
  const auto tags = *rc::gen::inRange(1, 20);
  const auto metres = [] { return *rc::gen::inRange(-100000, 100000) / 10000.0; };
  for (int i = 0; i < tags; ++i)
    recording.tags.push_back({fmt::format("{:08x}", i * 77), {metres(), metres(), metres()}});
  for (int i = 0; i < *rc::gen::inRange(0, 30); ++i) {
    recording.poses.push_back({i * 0.1, {{metres(), metres(), metres()}, 0.0, 0.0, 0.0}});
    recording.reads.push_back({i * 0.01, static_cast<std::uint32_t>(*rc::gen::inRange(0, tags)),
                               *rc::gen::inRange(1, 33), static_cast<double>(*rc::gen::inRange(-90, -20))});
  }
  const auto again = parse_recording(reads_csv(recording), poses_csv(recording), tags_csv(recording));
  RC_ASSERT(again.has_value());
  RC_ASSERT(again->reads.size() == recording.reads.size());
  for (std::size_t i = 0; i < recording.reads.size(); ++i) {
    RC_ASSERT(again->reads[i].tag == recording.reads[i].tag);
    RC_ASSERT(again->reads[i].port == recording.reads[i].port);
    RC_ASSERT(std::abs(again->reads[i].time_s - recording.reads[i].time_s) < 1e-6);
  }
  for (std::size_t i = 0; i < recording.tags.size(); ++i)
    RC_ASSERT(norm(again->tags[i].position - recording.tags[i].position) < 1e-4);
}

}  // namespace
}  // namespace forager::boards
