#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "boards/config_node.hpp"
#include "boards/config_reader.hpp"
#include "tests/scratch_folder.hpp"

namespace forager::boards {
namespace {

using testing::HasSubstr;

ConfigNode parsed(const std::string& text) {
  auto node = parse_config(text, "test.toml");
  EXPECT_TRUE(node.has_value()) << (node ? "" : describe(node.error()));
  return node ? *node : ConfigNode{};
}

TEST(Config, SyntaxErrorNamesFileLineAndColumn) {
  const auto node = parse_config("a = 1\nb = = 2\n", "test.toml");
  ASSERT_FALSE(node);
  EXPECT_EQ(node.error().code, hal::ErrorCode::invalid_argument);
  EXPECT_THAT(describe(node.error()), HasSubstr("test.toml: line 2, column"));
}

TEST(Config, LettersOutsideAsciiBelongInStringsAndComments) {
  for (const std::string text : {"# 50 \u00B5s\na = 'caf\u00E9'\n",
                                 "\xEF\xBB\xBF"
                                 "a = \"\\\"\u00E9\" # \u00E9",
                                 "a = \"\"\"x\"\"\"\"\nb = \"\u00E9\"", "a = '''\n\u00E9'\u00E9'''\n"})
    EXPECT_TRUE(parse_config(text, "test.toml").has_value()) << text;
  for (const std::string text : {"a = 1\n  caf\u00E9 = 2\n", "a = '\u00B5'\nb \u00B5", "a = 1\n  \xFF",
                                 "a = \"\"\"x\"\"\"\"\n  \u00E9 = \"y\""}) {
    const auto node = parse_config(text, "test.toml");
    ASSERT_FALSE(node) << text;
    EXPECT_THAT(describe(node.error()), HasSubstr("test.toml: line 2, column")) << text;
    EXPECT_THAT(describe(node.error()), HasSubstr("outside ASCII")) << text;
  }
}

TEST(Config, MissingFileSaysWhichAndWhatToDo) {
  const auto node = load_config("no/such/scene.toml");
  ASSERT_FALSE(node);
  EXPECT_EQ(node.error().code, hal::ErrorCode::not_present);
  EXPECT_THAT(describe(node.error()),
              HasSubstr("no/such/scene.toml: read file: cannot be read [No such file"));
}

TEST(Config, UnknownKeyIsFoundWithItsLineAndNearestKnownKey) {
  const ConfigNode root = parsed("[vehicle]\naltitude = 3.0\n");
  ConfigIssue issue;
  ConfigReader top(&root, "", issue);
  ConfigReader vehicle = top.table("vehicle");
  EXPECT_DOUBLE_EQ(vehicle.number("altitude_m", 1.5, {0.0, 10.0}), 1.5);
  EXPECT_FALSE(issue);
  check_unused(root, issue);
  ASSERT_TRUE(issue);
  EXPECT_EQ(describe(*issue),
            "test.toml:2: vehicle.altitude: is not a known key here. Did you mean 'altitude_m'?");
}

TEST(Config, WrongTypeAndRangeAreIssuesAndTheFirstOneStays) {
  const ConfigNode root = parsed("a = 40\nb = \"x\"\n");
  ConfigIssue issue;
  ConfigReader top(&root, "", issue);
  EXPECT_DOUBLE_EQ(top.number("a", 7.0, {0.0, 31.5}), 7.0);
  ASSERT_TRUE(issue);
  EXPECT_EQ(describe(*issue), "test.toml:1: a: is 40. Allowed: 0 to 31.5.");
  EXPECT_DOUBLE_EQ(top.number("b", 8.0, {0.0, 1.0}), 8.0);
  EXPECT_THAT(describe(*issue), HasSubstr("a: is 40"));
}

TEST(Config, NotANumberAndInfinityAreRefused) {
  for (const char* text : {"a = nan", "a = inf", "a = -inf"}) {
    const ConfigNode root = parsed(text);
    ConfigIssue issue;
    ConfigReader top(&root, "", issue);
    (void)top.number("a", 0.0, {});
    EXPECT_TRUE(issue) << text;
  }
}

TEST(Config, PointsMustHaveTheRightSize) {
  const ConfigNode root = parsed("p = [[1.0, 2.0], [3.0]]\n");
  ConfigIssue issue;
  ConfigReader top(&root, "", issue);
  EXPECT_TRUE(top.points("p", 2).empty());
  ASSERT_TRUE(issue);
  EXPECT_THAT(describe(*issue), HasSubstr("has 1 numbers. Write 2 numbers in brackets."));
}

class ConfigFiles : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) { return folder_.write(name, text); }
  test::ScratchFolder folder_;
};

TEST_F(ConfigFiles, BaseIsOverlaidKeyByKeyAndArraysAreReplaced) {
  write("base.toml", "[a]\nx = 1\ny = 2\nlist = [1, 2, 3]\n");
  const auto node = load_config(write("top.toml", "base = \"base.toml\"\n[a]\ny = 5\nlist = [9]\n"));
  ASSERT_TRUE(node) << describe(node.error());
  const ConfigNode* a = node->find("a");
  ASSERT_NE(a, nullptr);
  EXPECT_EQ(std::get<std::int64_t>(a->find("x")->value), 1);
  EXPECT_EQ(std::get<std::int64_t>(a->find("y")->value), 5);
  EXPECT_EQ(a->find("list")->array()->size(), 1U);
}

TEST_F(ConfigFiles, AFileThatNamesItselfAsBaseIsRefused) {
  const auto node = load_config(write("loop.toml", "base = \"loop.toml\"\n"));
  ASSERT_FALSE(node);
  EXPECT_THAT(describe(node.error()), HasSubstr("more than eight files"));
}

}  // namespace
}  // namespace forager::boards
