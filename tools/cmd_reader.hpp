#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace forager::tools {

enum class ReaderTask : std::uint8_t { info, watch, start, stop, gpio_list, gpio_set };

struct ReaderCommand {
  ReaderTask task = ReaderTask::info;
  std::string board = "sim";
  std::string host;        // not empty: this reader instead of the board's
  std::string scene;       // whose [reader] to use, and off-target whose tags; empty: the bench's own
  double timeout_s = 2.0;  // of each exchange
  bool json = false;
  std::uint64_t seed = 1;

  // watch
  bool listen = false;  // to a reader that runs for somebody else
  std::string wedge;    // name of one that types as a keyboard; instead of the board's reader
  double for_s = 0.0;   // 0: until told to stop
  double every_s = 1.0;
  std::uint64_t least_tags = 0;
  bool real_time = false;
  std::optional<std::string> session;
  std::optional<std::string> target;
  std::optional<double> power_dbm;
  std::optional<double> sensitivity_dbm;
  std::vector<int> ports;

  // gpio set
  unsigned line = 0;
  bool arm = false;
  double hold_s = 0.0;
};

// Looks at the reader of a board file, or at an emulated one. Gives an exit code of tools/cli_style.hpp:
// failure when the reader could not be reached or asked, when its link was not open at the end of a watch, or
// when it has not confirmed that it stopped; check failed with fewer tags than --least.
int run_reader_command(const ReaderCommand& command);

// Adds `forager reader`; exit_code gets its result when it runs.
void add_reader_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
