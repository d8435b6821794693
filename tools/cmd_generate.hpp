#pragma once

#include <cstdint>
#include <string>

namespace CLI {
class App;
}

namespace forager::tools {

struct GenerateCommand {
  std::string scene;
  std::string output;
  std::uint64_t seed = 1;
  bool layout = false;  // as the scene lists its tags instead of as they are
};

// Writes the tags of a scene's world into a tag file, for other programs or for another scene to name. Gives
// an exit code of tools/cli_style.hpp.
int run_generate_command(const GenerateCommand& command);

// Adds `forager generate`; exit_code gets its result when it runs.
void add_generate_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
