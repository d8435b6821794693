#include "tools/accuracy_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <sstream>

namespace forager::tools {
namespace {

using boards::AccuracyRow;
using testing::HasSubstr;

AccuracyRow row(const char* name, const char* variant, double time_ns, double error) {
  AccuracyRow r{.name = name, .variant = variant, .reference = "truth, \"all of it\""};
  r.time_ns = time_ns;
  r.max_abs_error = error;
  r.max_rel_error = 2.0 * error;
  return r;
}

std::vector<AccuracyRow> some_rows() {
  std::vector<AccuracyRow> rows{row("PD", "fast", 1.0, 1e-7),    row("PD", "<best>", 5.0, 1e-16),
                                row("PD", "slow", 9.0, 1e-12),   row("PD", "worse", 2.0, 1e-6),
                                row("way", "untimed", 0.0, 0.0), row("way", "only", 7.0, 3.0)};
  rows[0].asked = 10;
  rows[0].failures = 0;
  return rows;
}

TEST(AccuracyTable, TheFrontIsWhatNothingBeats) {
  const auto lines = with_pareto_fronts(some_rows());
  std::vector<bool> front;
  for (const AccuracyLine& line : lines) front.push_back(line.pareto);
  EXPECT_THAT(front, testing::ElementsAre(true, true, false, false, false, true));
}

TEST(AccuracyTable, AWayThatFailsLessOftenIsNotBeatenByAFasterOne) {
  auto rows = some_rows();
  rows[0].failures = 3;
  EXPECT_TRUE(with_pareto_fronts(rows)[3].pareto);  // "worse" answers always
}

TEST(AccuracyTable, TwoOfTheSameAreBothOnTheFront) {
  const auto lines = with_pareto_fronts({row("a", "x", 1.0, 1.0), row("a", "y", 1.0, 1.0)});
  EXPECT_TRUE(lines[0].pareto && lines[1].pareto);
}

TEST(AccuracyTable, CsvQuotesWhatWouldBeTakenForStructure) {
  const std::string csv = accuracy_csv(with_pareto_fronts(some_rows()));
  EXPECT_THAT(csv, testing::StartsWith(
                       "name,variant,time_ns,max_abs_error,max_rel_error,reference,asked,failures,pareto\r\n"
                       "PD,fast,1,1e-07,2e-07,\"truth, \"\"all of it\"\"\",10,0,1\r\n"));
}

TEST(AccuracyTable, JsonRowsAreWhole) {
  std::istringstream text(accuracy_json(with_pareto_fronts(some_rows())));
  std::size_t rows = 0;
  for (std::string line; std::getline(text, line); ++rows) {
    const auto j = nlohmann::json::parse(line);
    for (const char* key :
         {"name", "variant", "time_ns", "max_abs_error", "max_rel_error", "reference", "pareto"})
      EXPECT_TRUE(j.contains(key)) << key;
  }
  EXPECT_EQ(rows, 6U);
}

TEST(AccuracyTable, TextHasAHeadingForEachQuestionAndMarksTheFront) {
  const std::string text = accuracy_text(with_pareto_fronts(some_rows()));
  EXPECT_THAT(text, HasSubstr("PD  [against truth, \"all of it\"]\n"));
  EXPECT_THAT(text, HasSubstr("  * fast          1 ns    1.00e-07    2.00e-07\n"));
  EXPECT_THAT(text, HasSubstr("    slow          9 ns"));
}

TEST(AccuracyTable, ThePageIsWellFormedAndFetchesNothing) {
  const std::string page = accuracy_page(with_pareto_fronts(some_rows()));
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(page.c_str()));
  EXPECT_EQ(document.select_nodes("//*[local-name()='svg']").size(), 2U);
  // Every row with a time has its mark; the front of the first question is a line.
  EXPECT_EQ(document.select_nodes("//*[local-name()='circle']").size(), 5U);
  EXPECT_EQ(document.select_nodes("//*[local-name()='path'][@class='total']").size(), 1U);
  EXPECT_THAT(page, HasSubstr("&lt;best&gt;"));
  EXPECT_THAT(page, testing::Not(HasSubstr("src=")));
  EXPECT_THAT(page, testing::Not(HasSubstr("<script")));
}

}  // namespace
}  // namespace forager::tools
