#pragma once

#include <string>

namespace CLI {
class App;
}

namespace forager::tools {

struct DoctorCommand {
  std::string board;  // empty: the machine only
  bool json = false;
  bool only_trouble = false;
};

// Looks at this machine, at what the program was built with, and at every device of a board file; drives
// nothing. Gives kExitDone, kExitCheckFailed when a check failed, or kExitUsage for a mistake in the file.
int run_doctor_command(const DoctorCommand& command);

// Adds `forager doctor`; exit_code gets its result when it runs.
void add_doctor_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
