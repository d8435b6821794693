#pragma once

namespace CLI {
class App;
}

namespace forager::tools {

// Adds `forager usb`; exit_code gets its result when it runs.
void add_usb_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
