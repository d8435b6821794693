#pragma once

#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace forager::tools {

// What the last of `words` (those after "forager") may become, out of the very description that reads the
// command line: commands, options, or for a value that is a file one of the lines ":toml" and ":files", which
// tell the shell to look for them. For tools/forager.bash-completion.
[[nodiscard]] std::vector<std::string> completions(const CLI::App& app, std::span<const std::string> words);

}  // namespace forager::tools
