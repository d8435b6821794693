#include "tools/cmd_generate.hpp"

#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "boards/scene.hpp"
#include "boards/world_builder.hpp"
#include "tests/scratch_folder.hpp"
#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

constexpr const char* kBare = R"(
scene = { name = "x" }
reader = { session = "S0", port = [{ port = 1, bearing_deg = 0 }] }
mission = { policy = "stigmergy" }
)";

struct GenerateCommandTest : testing::Test {
  int run(const std::string& output, std::uint64_t seed = 1) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = run_generate_command({.scene = store, .output = output, .seed = seed});
    out = testing::internal::GetCapturedStdout();
    err = testing::internal::GetCapturedStderr();
    return code;
  }
  test::ScratchFolder folder;
  std::string store = folder.write(
      "store.toml", std::string(kBare) + "world.generate = { kind = \"square\", tags = 1500 }\n");
  std::string out;
  std::string err;
};

TEST_F(GenerateCommandTest, AnotherSceneFindsTheSameTagsInTheFile) {
  ASSERT_EQ(run(folder.file("tags.csv")), kExitDone) << err;
  EXPECT_EQ(out, "1500 tags in " + folder.file("tags.csv") + "\n");
  const auto made = boards::load_scene(store);
  const auto named =
      boards::load_scene(folder.write("file.toml", std::string(kBare) + "world.tag_file = \"tags.csv\"\n"));
  ASSERT_TRUE(made);
  ASSERT_TRUE(named) << describe(named.error());
  const mocks::World one = boards::build_world(*made, 1);
  const mocks::World other = boards::build_world(*named, 1);
  ASSERT_EQ(other.tags.size(), 1500U);
  for (std::size_t i = 0; i < 1500; ++i) {
    ASSERT_EQ(one.tags.epc_hex(i), other.tags.epc_hex(i));
    ASSERT_EQ(one.tags.position(i), other.tags.position(i));
  }
}

TEST_F(GenerateCommandTest, TheLayoutIsWrongWhereTheSceneSaysSo) {
  store = folder.write("wrong.toml", std::string(kBare) +
                                         "world.generate = { kind = \"square\", tags = 1000 }\n"
                                         "world.mislabeled = 0.02\nworld.unlisted = 0.01\n");
  ASSERT_EQ(run(folder.file("tags.csv")), kExitDone) << err;
  testing::internal::CaptureStdout();
  EXPECT_EQ(
      run_generate_command({.scene = store, .output = folder.file("layout.csv"), .seed = 1, .layout = true}),
      kExitDone);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "990 tags in " + folder.file("layout.csv") + "\n");
  std::istringstream truth(folder.read("tags.csv"));
  std::set<std::string> lines;
  for (std::string line; std::getline(truth, line);) lines.insert(line);
  std::istringstream list(folder.read("layout.csv"));
  int wrong = 0;
  for (std::string line; std::getline(list, line);) wrong += lines.contains(line) ? 0 : 1;
  EXPECT_EQ(wrong, 20);
}

TEST_F(GenerateCommandTest, TheSeedDecides) {
  ASSERT_EQ(run(folder.file("one.csv"), 1), kExitDone);
  ASSERT_EQ(run(folder.file("again.csv"), 1), kExitDone);
  ASSERT_EQ(run(folder.file("other.csv"), 2), kExitDone);
  EXPECT_EQ(folder.read("one.csv"), folder.read("again.csv"));
  EXPECT_NE(folder.read("one.csv"), folder.read("other.csv"));
}

TEST_F(GenerateCommandTest, WhatCannotBeWrittenIsSaid) {
  EXPECT_EQ(run(folder.file("no/such/tags.csv")), kExitUnavailable);
  EXPECT_NE(err.find("no/such/tags.csv"), std::string::npos) << err;
}

}  // namespace
}  // namespace forager::tools
