#include "tools/run_output.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "hal/units.hpp"

namespace forager::tools {
namespace {

using testing::HasSubstr;
using testing::Not;

boards::RunSummary a_mission() {
  boards::RunSummary s;
  s.scene = "4A";
  s.title = "300 tags, T shape";
  s.board = "sim";
  s.policy = "stigmergy";
  s.seed = 7;
  s.tags_present = 300;
  s.tags_read = 291;
  s.reads = 2000;
  s.sim_time_s = 210.0;
  s.flight_time_s = 200.0;
  s.path_m = 13.44;
  s.decisions = 60;
  s.windows = 41;
  s.end = flight::EndReason::no_new_tags;
  s.detail = "8 windows without a new tag";
  s.battery_fraction = 0.86;
  s.ports = {{4, "front", 0.0, 900, 120.0}, {3, "left", hal::kPi / 2.0, 1100, 171.0}};
  return s;
}

TEST(SummaryTable, SaysWhatTheMissionCameTo) {
  const std::string table = summary_table(a_mission(), 0.1);
  EXPECT_THAT(table, HasSubstr("4A - 300 tags, T shape\n"));
  EXPECT_THAT(table, HasSubstr("stigmergy, seed 7, board sim\n"));
  EXPECT_THAT(table, HasSubstr("291 of 300 (97.0 %)\n"));
  EXPECT_THAT(table, HasSubstr("2000 (10.0 a second of flight)\n"));
  EXPECT_THAT(table, HasSubstr("210.0 s, 200.0 s of it in flight; 0.10 s on the clock (2100 x)\n"));
  EXPECT_THAT(table, HasSubstr("13.4 m, 60 decisions in 41 windows\n"));
  EXPECT_THAT(table, HasSubstr("no_new_tags: 8 windows without a new tag\n"));
  EXPECT_THAT(table, HasSubstr("left"));
  EXPECT_THAT(table, Not(HasSubstr("CRASHES")));
  EXPECT_THAT(table, Not(HasSubstr("other tags")));
}

TEST(SummaryTable, CrashesAndBystandersShowWhenThereAreAny) {
  boards::RunSummary s = a_mission();
  s.crashes = 2;
  s.other_tags_read = 14;
  EXPECT_THAT(summary_table(s, 0.1), testing::ContainsRegex("CRASHES +2\n"));
  EXPECT_THAT(summary_table(s, 0.1), testing::ContainsRegex("other tags +14\n"));
}

TEST(SummaryTable, ARunThatNeverFlewDividesByNothing) {
  boards::RunSummary s;
  s.tags_present = 0;
  const std::string table = summary_table(s, 0.0);
  EXPECT_THAT(table, HasSubstr("0 of 0 (-)\n"));
  EXPECT_THAT(table, HasSubstr("0 (0.0 a second of flight)\n"));
  EXPECT_THAT(table, Not(HasSubstr("nan")));
  EXPECT_THAT(table, Not(HasSubstr("inf")));
}

TEST(SummaryTable, InARealPlaceThereIsNoShare) {
  boards::RunSummary s = a_mission();
  s.tags_present.reset();
  EXPECT_THAT(summary_table(s, 0.1), testing::ContainsRegex("tags read +291\n"));
}

TEST(SummaryTable, TextFromFilesAndDevicesCannotDriveTheTerminal) {
  boards::RunSummary s = a_mission();
  s.title = "tags\x1b[2J";
  s.detail = "reader said\r\nnothing";
  s.board = "drone\x07";
  s.ports[0].name = "front\n";
  const std::string table = summary_table(s, 0.1);
  for (const char c : table) EXPECT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= 0x20) << table;
  EXPECT_THAT(table, HasSubstr("reader said  nothing\n"));
}

TEST(SummaryJson, IsOneLineWithExactlyTheDocumentedKeys) {
  const std::string line = summary_json(a_mission(), 0.5);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const auto j = nlohmann::json::parse(line);
  std::set<std::string> keys;
  for (const auto& [key, value] : j.items()) keys.insert(key);
  EXPECT_EQ(keys, (std::set<std::string>{"event",
                                         "scene",
                                         "title",
                                         "board",
                                         "policy",
                                         "seed",
                                         "tags_present",
                                         "tags_read",
                                         "other_tags_read",
                                         "coverage",
                                         "reads",
                                         "sim_time_s",
                                         "flight_time_s",
                                         "wall_time_s",
                                         "path_m",
                                         "decisions",
                                         "windows",
                                         "end_reason",
                                         "detail",
                                         "reader_losses",
                                         "autopilot_losses",
                                         "radio_may_be_on",
                                         "crashes",
                                         "battery",
                                         "ports"}));
  EXPECT_EQ(j["event"], "summary");
  EXPECT_DOUBLE_EQ(j["coverage"], 0.97);
  EXPECT_EQ(j["end_reason"], "no_new_tags");
  EXPECT_DOUBLE_EQ(j["battery"], 0.86);
  ASSERT_EQ(j["ports"].size(), 2U);
  EXPECT_EQ(j["ports"][1]["name"], "left");
  EXPECT_DOUBLE_EQ(j["ports"][1]["bearing_deg"], 90.0);
  EXPECT_DOUBLE_EQ(j["ports"][1]["new_tags"], 171.0);
}

TEST(SummaryJson, WhatIsNotKnownIsNull) {
  boards::RunSummary s = a_mission();
  s.tags_present.reset();
  s.battery_fraction.reset();
  const auto j = nlohmann::json::parse(summary_json(s, 0.5));
  EXPECT_TRUE(j["tags_present"].is_null());
  EXPECT_TRUE(j["coverage"].is_null());
  EXPECT_TRUE(j["battery"].is_null());
  s.tags_present = 0;
  EXPECT_TRUE(nlohmann::json::parse(summary_json(s, 0.5))["coverage"].is_null());
}

TEST(SummaryJson, BytesThatAreNotUtf8AreReplacedAndTheLineStaysWhole) {
  boards::RunSummary s = a_mission();
  s.detail = "reader said \xff\xfe\n\"x\"";
  s.path_m = std::numeric_limits<double>::quiet_NaN();
  const std::string line = summary_json(s, 0.5);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const auto j = nlohmann::json::parse(line);
  EXPECT_THAT(j["detail"].get<std::string>(), HasSubstr("\n\"x\""));
  EXPECT_TRUE(j["path_m"].is_null());
}

}  // namespace
}  // namespace forager::tools
