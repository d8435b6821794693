#include "tools/cmd_report.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "reader/inventory_store.hpp"
#include "tests/scratch_folder.hpp"
#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;

class ReportCommand : public testing::Test {
 protected:
  void SetUp() override {
    auto store = reader::open_sqlite_inventory(file("run.db"), reader::StoreMode::create);
    if (!store && store.error().code == hal::ErrorCode::unsupported) GTEST_SKIP() << "built without SQLite";
    std::vector<reader::LocatedRead> reads(3);
    for (std::size_t i = 0; i < reads.size(); ++i) {
      reads[i].read.epc = reader::Epc::from_hex(i == 2 ? "30390002" : "30390001").value();
      reads[i].read.port = static_cast<std::uint8_t>(i + 1);
      reads[i].read.rssi_dbm = static_cast<std::int16_t>(-70 + static_cast<int>(i));
      reads[i].read.heard = hal::Instant(1s * (i + 1));
    }
    ASSERT_TRUE((*store)->commit(1, reads));
    ASSERT_TRUE((*store)->set_fact("scene", "4A \"T\"\x1b[2J"));
  }
  std::string file(const std::string& name) const { return folder_.file(name); }

  // Through the command line, as a person would.
  int run(std::vector<std::string> arguments) {
    CLI::App app("forager");
    int exit_code = -1;
    add_report_command(app, exit_code);
    arguments.insert(arguments.begin(), "report");
    std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them last first
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    app.parse(arguments);
    out_ = testing::internal::GetCapturedStdout();
    err_ = testing::internal::GetCapturedStderr();
    return exit_code;
  }

  test::ScratchFolder folder_;
  std::string out_;
  std::string err_;
};

TEST_F(ReportCommand, ShowsFactsAndSummaryAndCannotBeMadeToDriveTheTerminal) {
  EXPECT_EQ(run({file("run.db")}), kExitDone);
  EXPECT_NE(out_.find("scene      4A \"T\" [2J\n"), std::string::npos) << out_;
  EXPECT_NE(out_.find("items      2\n"), std::string::npos) << out_;
  EXPECT_NE(out_.find("reads      3 in 1 batch\n"), std::string::npos) << out_;
  EXPECT_EQ(out_.find('\x1b'), std::string::npos);
  EXPECT_EQ(out_.find("30390001"), std::string::npos) << "items only when asked for";
  EXPECT_EQ(err_, "");
}

TEST_F(ReportCommand, JsonLinesParseAndAgreeWithTheFile) {
  EXPECT_EQ(run({file("run.db"), "--json", "--items"}), kExitDone);
  std::istringstream lines(out_);
  std::string line;
  std::getline(lines, line);
  const auto summary = nlohmann::json::parse(line);
  EXPECT_EQ(summary["items"], 2);
  EXPECT_EQ(summary["reads"], 3);
  EXPECT_EQ(summary["facts"]["scene"], "4A \"T\"\x1b[2J");
  EXPECT_EQ(summary["ports"].size(), 3U);
  int items = 0;
  while (std::getline(lines, line)) {
    EXPECT_EQ(nlohmann::json::parse(line)["type"], "item");
    ++items;
  }
  EXPECT_EQ(items, 2);
}

TEST_F(ReportCommand, CsvGoesToAFileOrTakesStdoutForItself) {
  EXPECT_EQ(run({file("run.db"), "--csv", file("out.csv")}), kExitDone);
  std::ifstream in(file("out.csv"), std::ios::binary);
  const std::string written(std::istreambuf_iterator<char>(in), {});
  EXPECT_EQ(written.substr(0, 4), "epc,");
  EXPECT_NE(out_.find("Inventory"), std::string::npos);
  EXPECT_EQ(run({file("run.db"), "--csv", "-"}), kExitDone);
  EXPECT_EQ(out_, written);
}

TEST_F(ReportCommand, ALayoutTellsWhatIsNotWhereItShouldBe) {
  std::ofstream(file("layout.csv")) << "epc,x,y,z\n30390001,1,2,1\n3039aaaa,4,2,1\n";
  EXPECT_EQ(run({file("run.db"), "--layout", file("layout.csv")}), kExitDone);
  EXPECT_NE(out_.find("0 of 2 in place, 0 elsewhere, 1 unheard, 1 not listed, 1 heard without a pose\n"),
            std::string::npos)
      << out_;
  EXPECT_NE(out_.find("30390002  not listed\n"), std::string::npos) << out_;
  EXPECT_EQ(run({file("run.db"), "--json", "--layout", file("layout.csv")}), kExitDone);
  std::istringstream lines(out_);
  std::string line;
  std::getline(lines, line);
  std::getline(lines, line);
  EXPECT_EQ(nlohmann::json::parse(line)["type"], "layout");
  EXPECT_EQ(nlohmann::json::parse(line)["unheard"], 1);
  std::getline(lines, line);
  EXPECT_EQ(nlohmann::json::parse(line)["epc"], "30390002");
  EXPECT_EQ(run({file("run.db"), "--layout", file("none.csv")}), kExitUnavailable);
}

TEST_F(ReportCommand, ErrorsAreOneLineWithTheRightExitCode) {
  EXPECT_EQ(run({file("none.db")}), kExitUnavailable);
  EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
  EXPECT_NE(err_.find("none.db"), std::string::npos);
  std::ofstream(file("text.db")) << std::string(3000, 'x');
  EXPECT_EQ(run({file("text.db")}), kExitFailure);
  EXPECT_EQ(run({file("run.db"), "--csv", file("no/folder/out.csv")}), kExitUnavailable);
  EXPECT_EQ(run({file("run.db"), "--csv", "-", "--json"}), kExitUsage);
  EXPECT_EQ(out_, "");
}

}  // namespace
}  // namespace forager::tools
