#pragma once

namespace CLI {
class App;
}

namespace forager::tools {

// Adds `forager modbus list`, `show` and `set`: devices and registers by the names that a board file gives
// them, in the units of their manuals. exit_code gets the result of the one that runs.
void add_modbus_names(CLI::App& modbus, int& exit_code);

}  // namespace forager::tools
