#pragma once

#include <string>

namespace CLI {
class App;
}

namespace forager::tools {

// The manual page forager(1) as man(7) markup, out of the very description that reads the command line: every
// command with all of its options. The same program gives the same bytes.
[[nodiscard]] std::string manual_page(const CLI::App& app, const std::string& version);

// Adds `forager manual`, which prints it.
void add_manual_command(CLI::App& app, const std::string& version, int& exit_code);

}  // namespace forager::tools
