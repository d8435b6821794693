#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace forager::tools {

// What both emulators share.
struct EmulateCommand {
  std::string scene;
  std::uint64_t seed = 1;  // the same as the run's, or the tags are others
  double speed = 1.0;      // of real time; the same for every process of a run
  double for_s = 0.0;      // stop after so many seconds on the clock; 0: until told to
  bool json = false;
  bool quiet = false;  // neither notes nor status
};

struct EmulateReaderCommand : EmulateCommand {
  std::string host = "127.0.0.1";
  std::uint16_t rest_port = 3161;
  std::uint16_t stream_port = 3177;
  std::string truth = "127.0.0.1:14572";  // where the autopilot's truth feed is received
  std::string user;                       // not empty: digest login
  std::string password_env;               // environment variable with its password
};

struct EmulateAutopilotCommand : EmulateCommand {
  std::string listen = "127.0.0.1:14550";
  std::string serial;  // not empty: a serial port of this name instead
  std::vector<std::string> truth{"127.0.0.1:14571", "127.0.0.1:14572"};  // who is told the truth
  std::string refuse_arming;
};

// Serve an emulated device of a scene on real sockets until SIGINT, SIGTERM or the time is over. Give an exit
// code of tools/cli_style.hpp: failure when an address is in use.
int run_emulate_reader_command(const EmulateReaderCommand& command);
int run_emulate_autopilot_command(const EmulateAutopilotCommand& command);

// Adds `forager emulate`; exit_code gets its result when it runs.
void add_emulate_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
