#pragma once

namespace CLI {
class App;
}

namespace forager::tools {

struct StressCommand {
  bool json = false;
};

// Puts every numerically hard case to the code and prints the worst error of each beside its bound. Gives an
// exit code of tools/cli_style.hpp: check failed when a case is beyond its bound.
int run_stress(const StressCommand& command);

// Adds `forager stress`; exit_code gets its result when it runs.
void add_stress_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
