#include "mocks/tag_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "hal/random.hpp"
#include "tests/scratch_folder.hpp"

namespace forager::mocks {
namespace {

using testing::HasSubstr;

constexpr const char* kEpc = "3034257bf7194e4000001a85";

std::string complaint(const std::string& text) {
  TagList tags;
  const auto parsed = parse_tags(text, "tags.csv", tags);
  return parsed ? "accepted" : describe(parsed.error());
}

TEST(TagFile, ReadsTagsWithAndWithoutTheLastColumn) {
  TagList tags;
  ASSERT_TRUE(
      parse_tags("epc,x,y,z\n3034257BF7194E4000001A85,1.5,-1.75,0.8\r\n3034,1e3,0,-2.5e-1", "t", tags));
  ASSERT_EQ(tags.size(), 2U);
  EXPECT_EQ(tags.epc_hex(0), kEpc);
  EXPECT_EQ(tags.position(0), (hal::Vec3{1.5, -1.75, 0.8}));
  EXPECT_TRUE(tags.wanted(0));
  EXPECT_EQ(tags.epc_hex(1), "3034");
  EXPECT_EQ(tags.position(1), (hal::Vec3{1000.0, 0.0, -0.25}));
  TagList more;
  ASSERT_TRUE(parse_tags("epc,x,y,z,wanted\n3034,0,0,0,0\n3035,0,0,0,1\n", "t", more));
  EXPECT_FALSE(more.wanted(0));
  EXPECT_TRUE(more.wanted(1));
  TagList none;
  EXPECT_TRUE(parse_tags("epc,x,y,z\n", "t", none));
  EXPECT_TRUE(none.empty());
}

TEST(TagFile, SaysWhereTheMistakeIs) {
  const std::string head = "epc,x,y,z,wanted\n";
  const std::string good = "3034,1,2,3,1\n";
  const struct {
    std::string text;
    const char* where;
    const char* what;
  } cases[] = {
      {"", "line 1, column 1", "empty"},
      {"\n", "line 1, column 1", "epc,x,y,z"},
      {"EPC,X,Y,Z\n", "line 1, column 1", "epc,x,y,z"},
      {head + "\n", "line 2, column 1", "0 values instead of 5"},
      {head + good + "3035,1,2,3\n", "line 3, column 11", "4 values instead of 5"},
      {head + "3035,1,2,3,1,\n", "line 2, column 14", "more than 5"},
      {head + "303,1,2,3,1\n", "line 2, column 1", "has 3 digits"},
      {head + ",1,2,3,1\n", "line 2, column 1", "has 0 digits"},
      {head + std::string(128, 'a') + ",1,2,3,1\n", "line 2, column 1", "has 128 digits"},
      {head + "30g5,1,2,3,1\n", "line 2, column 1", "not hexadecimal"},
      {head + "3035, 1,2,3,1\n", "line 2, column 6", "not a number"},
      {head + "3035,1,,3,1\n", "line 2, column 8", "not a number"},
      {head + "3035,1,2,nan,1\n", "line 2, column 10", "not a number"},
      {head + "3035,1,2,inf,1\n", "line 2, column 10", "not a number"},
      {head + "3035,1,2,1e10,1\n", "line 2, column 10", "within"},
      {head + "3035,1,2,3x,1\n", "line 2, column 10", "not a number"},
      {head + "3035,1,2,1e999,1\n", "line 2, column 10", "not a number"},
      {head + "3035,1,2,3,yes\n", "line 2, column 12", "neither 1"},
      {head + good + "3034,9,9,9,1\n", "line 3, column 1", "there already, as tag 1"},
      {head + std::string(2000, 'x') + "\n", "line 2", "too long"},
      {head + "30\x01\xff,1,2,3,1\n", "line 2, column 1", "30??"},
  };
  for (const auto& c : cases) {
    const std::string said = complaint(c.text);
    EXPECT_THAT(said, HasSubstr("tags.csv"));
    EXPECT_THAT(said, HasSubstr(c.where)) << c.text.substr(0, 60);
    EXPECT_THAT(said, HasSubstr(c.what)) << c.text.substr(0, 60);
  }
}

class TagFileOnDisk : public testing::Test {
 protected:
  test::ScratchFolder folder_;
};

// More than the pieces it is read in, so that lines are cut in two.
TEST_F(TagFileOnDisk, WhatIsWrittenIsReadBackToTheBit) {
  TagList tags;
  hal::Random random(2);
  for (int i = 0; i < 40'000; ++i) {
    const double x = random.uniform(-1e6, 1e6);
    tags.push_back({fmt::format("3034257bf7194e40{:08x}", i), {x, random.uniform(), 0.1 * i}, i % 3 != 0});
  }
  tags.push_back({"30342222", {}, true});
  const std::string path = folder_.file("tags.csv");
  ASSERT_TRUE(write_tag_file(path, tags));
  ASSERT_GT(std::filesystem::file_size(path), 2'000'000U);
  TagList read;
  const auto done = read_tag_file(path, read);
  ASSERT_TRUE(done) << describe(done.error());
  ASSERT_EQ(read.size(), tags.size());
  for (std::size_t i = 0; i < tags.size(); ++i) {
    ASSERT_EQ(read.position(i), tags.position(i)) << i;
    ASSERT_EQ(read.wanted(i), tags.wanted(i));
    ASSERT_EQ(read.epc_hex(i), tags.epc_hex(i));
  }
}

TEST_F(TagFileOnDisk, ALineWithoutEndIsRefusedNotSwallowed) {
  const std::string path = folder_.file("long.csv");
  std::ofstream(path) << "epc,x,y,z\n" << std::string(3'000'000, 'a');
  TagList tags;
  const auto read = read_tag_file(path, tags);
  ASSERT_FALSE(read);
  EXPECT_THAT(describe(read.error()), HasSubstr("line 2"));
}

TEST_F(TagFileOnDisk, FilesThatAreNotThere) {
  TagList tags;
  const auto missing = read_tag_file(folder_.file("none.csv"), tags);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, hal::ErrorCode::not_present);
  const auto folder = read_tag_file(folder_.path(), tags);
  ASSERT_FALSE(folder);
  EXPECT_FALSE(write_tag_file(folder_.file("no/such/folder.csv"), tags));
}

}  // namespace
}  // namespace forager::mocks
