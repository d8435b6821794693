// A mission as a service: what systemd hears of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/notify_listener.hpp"
#include "tests/places.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/tools/program.hpp"

namespace forager::tools {
namespace {

TEST(Service, AMissionSaysThatItIsReadyAndThatItLives) {
  test::ScratchFolder folder;
  test::NotifyListener systemd(folder.file("notify"));
  const ProgramResult flown =
      run_program({"run", test::source_path("scenes/4A.toml"), "--no-files", "--quiet"},
                  {.folder = folder.path(),
                   .environment = {{"NOTIFY_SOCKET", folder.file("notify")}, {"WATCHDOG_USEC", "2000000"}}});
  EXPECT_EQ(flown.exit_code, 0) << flown.err;
  const std::vector<std::string> heard = systemd.heard();
  ASSERT_GE(heard.size(), 2U);
  EXPECT_EQ(heard[0], "READY=1");
  EXPECT_EQ(heard[1], "WATCHDOG=1");
}

}  // namespace
}  // namespace forager::tools
