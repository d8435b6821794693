#pragma once

#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "tests/scratch_folder.hpp"
#include "tests/tools/fake_machine.hpp"
#include "tests/tools/program.hpp"

// The real program's doctor on a machine with pins (fake_machine) and files of a test's own.
namespace forager::tools {

// The line a check printed, and the mend below it.
inline std::string told(const std::string& out, const std::string& check) {
  std::istringstream in(out);
  for (std::string line; std::getline(in, line);) {
    if (line.find(check + ": ") == std::string::npos) continue;
    std::string mend;
    std::getline(in, mend);
    return line + (mend.find("mend: ") != std::string::npos ? "\n" + mend : "");
  }
  return {};
}

class CmdDoctor : public testing::Test {
 protected:
  // A board whose reader and autopilot are emulated, so that the rest decides.
  std::string board(const std::string& devices, const std::string& kind = "sim") {
    return folder_.write("robot.toml", "[board]\nname = \"robot\"\nkind = \"" + kind + "\"\n" + devices);
  }
  ProgramResult examine(const std::string& devices, FakeMachine machine = {}) {
    return run_program({"doctor", board(devices)}, machine.options());
  }
  test::ScratchFolder folder_;
};

inline constexpr const char* kButton =
    "[[gpio]]\nname = \"stop_button\"\nchip = \"pinctrl-bcm2711\"\nline = \"GPIO5\"\n";

}  // namespace forager::tools
