// `forager usb` and `forager hid` from outside, on emulated devices.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/tools/program.hpp"
#include "tests/tools/socket_rig.hpp"

namespace forager::tools {
namespace {

using testing::HasSubstr;

struct Case {
  std::vector<std::string> arguments;
  int exit_code;
  std::string out;
};

TEST(CmdPlug, PrintsWhatIsPluggedInAndWhatComesAndGoes) {
  const std::vector<Case> cases{
      {{"usb", "list", "--sim"}, 0, "1-1      1209:0001  forager Bulk echo, serial SN42  driver none\n"},
      {{"usb", "watch", "--sim", "--for", "3s"},
       0,
       "    0.000 s  plugged in  1-1      1209:0001  forager Bulk echo, serial SN42  driver none\n"
       "    1.000 s  plugged in  1-2      1209:0001  forager Bulk echo, serial SN43  driver none\n"
       "             this user may not open it: install boards/99-forager.rules, and plug it in again\n"
       "    2.000 s  unplugged   1-2      1209:0001  forager Bulk echo, serial SN43  driver none\n"},
      {{"hid", "list", "--sim"},
       0,
       "/dev/hidraw0   1209:0002  Report echo, serial SN7, usage ff00:0001, driver hid-generic\n"},
      {{"hid", "watch", "--sim", "--for", "3s"}, 0, ""},
      {{"hid", "watch", "1209:0002", "--sim", "--for", "900ms"}, 0, ""},
  };
  for (const Case& it : cases) {
    SCOPED_TRACE(testing::PrintToString(it.arguments));
    const ProgramResult result = run_program(it.arguments);
    EXPECT_EQ(result.exit_code, it.exit_code) << result.err;
    EXPECT_EQ(result.out, it.out);
    EXPECT_EQ(result.err, "");
  }
}

TEST(CmdPlug, JsonHasTheSame) {
  const auto events = lines_of(run_program({"usb", "watch", "--sim", "--for", "3s", "--json"}).out);
  ASSERT_EQ(events.size(), 3U);
  EXPECT_EQ(events[0]["event"], "arrived");
  EXPECT_EQ(events[1]["permitted"], false);
  EXPECT_EQ(events[1]["path"], "1-2");
  EXPECT_EQ(events[2]["event"], "left");
  EXPECT_EQ(events[2]["t_s"], 2.0);
  const Json hid = last_event(run_program({"hid", "list", "--sim", "--json"}).out, "device");
  EXPECT_EQ(hid["product"], "0002");
  EXPECT_EQ(hid["usage_page"], 0xFF00);
}

TEST(CmdPlug, ReportsOfADeviceArePrinted) {
  const ProgramResult result =
      run_program({"hid", "watch", "/dev/hidraw0", "--sim", "--for", "2s", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Json report = last_event(result.out, "report");
  EXPECT_EQ(report["t_s"], 1.0);
  EXPECT_THAT(report["hex"].get<std::string>(), testing::StartsWith("6869"));
  EXPECT_EQ(report["hex"].get<std::string>().size(), 128U);
}

TEST(CmdPlug, WhatIsNotThereIsNamed) {
  const ProgramResult absent = run_program({"hid", "watch", "04d8:00dd", "--sim", "--for", "1"});
  EXPECT_EQ(absent.exit_code, 3);
  EXPECT_EQ(absent.out, "");
  EXPECT_THAT(absent.err, HasSubstr("hid 04d8:00dd"));
  EXPECT_EQ(std::count(absent.err.begin(), absent.err.end(), '\n'), 1) << absent.err;
}

TEST(CmdPlug, AnEndlessWatchOfWhatIsEmulatedIsRefused) {
  for (const char* device : {"usb", "hid"}) {
    const ProgramResult result = run_program({device, "watch", "--sim"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("--for"));
  }
}

// Whatever this machine has: a list, or one line that says why there is none.
TEST(CmdPlug, ThisMachineIsLookedAtOrTheReasonIsGiven) {
  for (const char* device : {"usb", "hid"}) {
    const ProgramResult result = run_program({device, "list"});
    SCOPED_TRACE(device);
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 1 || result.exit_code == 3) << result.err;
    EXPECT_FALSE(result.out.empty() && result.err.empty());
    if (result.exit_code == 3) {
      EXPECT_THAT(result.err, HasSubstr("built without"));
    }
  }
}

}  // namespace
}  // namespace forager::tools
